from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from recalib.errors import UnknownName
from recalib.learners.rules import Rules
from recalib.study.configuration.switches import SWITCHES
from recalib.study.experiments import samples, search
from recalib.study.experiments.settings import best, rules_of
from recalib.study.layout import SEARCHED
from recalib.study.trainings import Trainings, rules, training
from tests.conftest import ROOT

RANGES = {
    "initial_width": [0.2, 5],
    "final_width": [0.1, 1],
    "initial_rate": [0.2, 1],
    "final_rate": [0.05, 1],
}
RULES = Rules(True, True, True, True)


def test_trials_fill_the_ranges_and_widths_and_rates_fall():
    trials = search.draw(RULES, RANGES, 64, seed=1)
    assert len(trials) == 64 and list(trials) == search.columns(RULES)
    assert trials["initial_width"].between(0.2, 5).all() and trials["initial_width"].min() < 0.25
    for width in search.columns(RULES)[1:-2]:
        assert (trials[width] / trials["initial_width"]).between(0.0999, 1.001).all()
    assert (trials["final_rate"] <= trials["initial_rate"] * 1.001).all() and trials[
        "initial_rate"
    ].max() <= 1


def test_trials_follow_from_their_seed():
    assert search.draw(RULES, RANGES, 8, seed=1).equals(search.draw(RULES, RANGES, 8, seed=1))
    assert not search.draw(RULES, RANGES, 8, seed=1).equals(search.draw(RULES, RANGES, 8, seed=2))


@pytest.mark.parametrize("index", range(5))
def test_the_second_round_surrounds_the_best_and_stays_inside_the_ranges(index):
    best = search.draw(RULES, RANGES, 8, seed=1).iloc[index]
    near = search.draw(RULES, RANGES, 64, seed=2, around=best)
    spread = np.log(near["initial_width"].max() / near["initial_width"].min())
    assert spread <= search.ZOOM * np.log(5 / 0.2) + 0.01
    assert near["initial_width"].min() <= best["initial_width"] * 1.1
    assert near["initial_width"].max() >= best["initial_width"] / 1.1
    assert near["initial_width"].between(0.2, 5).all()
    assert (near["position/g_k"] / near["initial_width"]).between(0.0999, 1.001).all()
    assert near["initial_rate"].between(0.1999, 1.0001).all()


def test_a_frame_of_trials_is_a_schedule_of_runs():
    trials = search.draw(RULES, RANGES, 4, seed=1)
    schedule = search.schedule(trials, RULES, repeat=3)
    assert np.array_equal(schedule.initial_width, np.repeat(trials["initial_width"], 3))
    assert np.array_equal(
        schedule.final_widths["orientation"][1], np.repeat(trials["orientation/g_kl"], 3)
    )
    assert isinstance(search.schedule(trials.iloc[0], RULES).final_rate, float)


def test_the_score_is_the_worse_of_both_errors():
    frame = pd.DataFrame(
        {"position_error_cm": [1.0, 2.0, 4.0], "orientation_error_deg": [4.0, 3.0, 2.0]}
    )
    assert search.score(frame).tolist() == [4.0, 3.0, 4.0]


def test_a_training_is_a_learner_and_its_iterations(study):
    assert training(study, "ritter") == ("ritter", 10_000)
    assert training(study, "ritter_200") == ("ritter", 200)
    assert training(study, "ritter_double") == ("ritter_double", 10_000)
    assert str(training(study, "ritter_200")) == "ritter_200"
    for wrong in ("riter", "ritter_0", "ritter_-5", "ritter_2x"):
        with pytest.raises(UnknownName, match=r"improved.*ritter_ITERATIONS"):
            training(study, wrong)


def test_rules_are_what_the_configuration_says(study):
    assert rules_of(rules(study, "improved")) == Rules(True, True, True, True)
    assert rules_of(rules(study, "ritter")) == Rules(False, False, False, False)
    assert rules_of(rules(study, "ritter_double")).supernet == (3, 6, 3)


@pytest.mark.parametrize("switch", SWITCHES)
def test_a_switch_changes_one_thing_of_each_system(study, switch):
    improved, ritter = (rules(study, name).model_dump() for name in ("improved", "ritter_200"))
    without, added = (rules(study, name).model_dump() for name in (switch.without, switch.added))
    assert without == improved | {switch.key: ritter[switch.key]} != improved
    assert added == ritter | {switch.key: improved[switch.key]} != ritter


def test_a_sample_says_what_it_was_searched_for_and_a_broken_one_is_refused(plan, tmp_path):
    path = tmp_path / "improved_200.csv"
    trials = search.draw(RULES, RANGES, 4, seed=1).assign(position_error_cm=[3.0, 1, 2, 4])
    trials["orientation_error_deg"] = [1.0, 2, 1.5, 1]
    samples.write_sample(path, plan.sample("improved_200"), trials)
    assert samples.searched_for(path) == plan.sample("improved_200")
    assert samples.read_sample(path).equals(trials)
    assert samples.best_trial(path) == trials.loc[1].to_dict()
    assert best(samples.read_sample(path)).name == 1, (
        "its worse error is the smallest; the first of two"
    )
    path.write_text("round,initial_width\n1,2\n")
    with pytest.raises(samples.BrokenSample, match="improved_200.csv holds no sample"):
        samples.read_sample(path)


@pytest.mark.parametrize(
    "path", sorted(Path(ROOT, SEARCHED).glob("*.csv")), ids=lambda path: path.stem
)
def test_a_shipped_sample_was_searched_for_what_the_study_trains(study, plan, path):
    assert samples.searched_for(path) == plan.sample(path.stem)
    trials = samples.read_sample(path)
    assert trials.groupby("round").size().tolist() == [study.search.trials] * study.search.rounds


def test_there_is_a_shipped_sample_for_every_training(study):
    shipped = {path.stem for path in Path(ROOT, SEARCHED).glob("*.csv")}
    assert shipped == set(Trainings(study).tuned())
