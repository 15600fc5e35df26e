from itertools import product
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from recalib.errors import InvalidFile, UnknownName
from recalib.learners.rules import Rules
from replication.config.shipped import SEARCHED
from replication.config.switches import SWITCHES
from replication.training import samples, search
from replication.training.settings import best, build_tuned, rules_of
from replication.training.trainings import Trainings, rules, searches, training
from replication.training.trainings import budget as budget_of
from replication.training.trials import search_for
from tests.conftest import ROOT
from workflow.scripts.call import write

RANGES = {
    "initial_width": [0.2, 5],
    "final_width": [0.1, 1],
    "initial_rate": [0.2, 1],
    "final_rate": [0.05, 1],
}
RULES = Rules(True, True, True, True)


def rng(seed):
    return np.random.default_rng(seed)


def test_trials_fill_the_ranges_and_widths_and_rates_fall():
    trials = search.draw(RULES, RANGES, 64, rng(1))
    assert len(trials) == 64 and list(trials) == search.columns(RULES)
    assert trials["initial_width"].between(0.2, 5).all() and trials["initial_width"].min() < 0.25
    for width in search.columns(RULES)[1:-2]:
        assert (trials[width] / trials["initial_width"]).between(0.0999, 1.001).all()
    assert (trials["final_rate"] <= trials["initial_rate"] * 1.001).all() and trials[
        "initial_rate"
    ].max() <= 1


@pytest.mark.parametrize("index", range(5))
def test_the_second_round_surrounds_the_best_and_stays_inside_the_ranges(index):
    best = search.draw(RULES, RANGES, 8, rng(1)).iloc[index]
    near = search.draw(RULES, RANGES, 64, rng(2), around=best)
    spread = np.log(near["initial_width"].max() / near["initial_width"].min())
    assert spread <= search.ZOOM * np.log(5 / 0.2) + 0.01
    assert near["initial_width"].min() <= best["initial_width"] * 1.1
    assert near["initial_width"].max() >= best["initial_width"] / 1.1
    assert near["initial_width"].between(0.2, 5).all()
    assert (near["position/g_k"] / near["initial_width"]).between(0.0999, 1.001).all()
    assert near["initial_rate"].between(0.1999, 1.0001).all()


@pytest.mark.parametrize(
    ("score", "expected"), [("worse", [2.0, 0.75]), ("geometric_mean", [1.0, 0.75])]
)
def test_the_score_is_the_part_left_of_the_initial_errors(study, score, expected):
    errors = pd.DataFrame({"position_error_cm": [4.0, 1.5], "orientation_error_deg": [2.0, 3.0]})
    initial = {"position_error_cm": 2.0, "orientation_error_deg": 4.0}
    published = study.search.initial.model_copy(update=initial)
    budget = study.search.model_copy(update={"score": score, "initial": published})
    assert search.scores(errors, budget).tolist() == expected


@pytest.fixture
def searched(study, plan, tmp_path):
    """A function that searches in no time: few trials of few iterations, on an easy damage."""
    path = tmp_path / "rotation.json"
    write(path, plan.resolved("rotation"))
    budget = budget_of(study).model_copy(update={"rounds": 2, "trials": 4, "seeds": 1})
    learner = rules(study, "improved_200").model_copy(update={"iterations": 3})
    small = {"budget": budget, "learner": learner, "tests": 5, "first": 0, "last": 3}

    def searched(**update):
        return search_for(path, **{"training": "improved_200"} | small | update)

    return searched


def test_every_search_has_a_sequence_of_its_own(searched):
    trials = searched()
    assert trials.groupby(["search", "round"]).size().tolist() == [4] * 6
    assert trials["initial_width"].nunique() == len(trials)
    others = searched(training="improved_single_map_200")
    assert not set(others["initial_width"]) & set(trials["initial_width"])


def test_a_search_does_not_depend_on_those_beside_it(searched):
    alone = searched(first=1, last=2)
    beside = searched().query("search == 2").reset_index(drop=True)
    pd.testing.assert_frame_equal(alone, beside)


def test_a_training_is_a_learner_and_its_iterations(study):
    assert training(study, "ritter") == ("ritter", 10_000)
    assert training(study, "ritter_200") == ("ritter", 200)
    assert training(study, "ritter_double") == ("ritter_double", 10_000)
    assert str(training(study, "ritter_200")) == "ritter_200"
    for wrong in ("riter", "ritter_0", "ritter_-5", "ritter_2x"):
        with pytest.raises(UnknownName, match=r"did you mean ritter\?"):
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


def test_a_sample_says_what_it_was_searched_for_and_a_broken_one_is_refused(study, sample):
    path, trials = sample
    job = samples.sought(study, "improved_200").model_copy(update={"searches": 2})
    assert samples.searched_for(path) == job
    assert samples.read_sample(path).equals(trials)
    path.write_text("round,initial_width\n1,2\n")
    with pytest.raises(InvalidFile, match="improved_200.csv: it holds no sample"):
        samples.read_sample(path)


@pytest.fixture
def sample(study, tmp_path):
    """A file, with four trials of each of two searches; two of the second are equally good."""
    trials = search.draw(RULES, RANGES, 8, rng(1))
    trials.insert(0, "search", [1] * 4 + [2] * 4)
    trials = trials.assign(score=[0.1, 0.2, 0.4, 0.3, 0.3, 0.2, 0.2, 0.4])
    job = samples.sought(study, "improved_200").model_copy(update={"searches": 2})
    path = tmp_path / "improved_200.csv"
    path.write_text(samples.sample_of(job, trials))
    return path, trials


def test_the_winner_of_each_search_is_its_best_trial_the_first_of_two(sample):
    path, trials = sample
    assert best(trials).index.tolist() == [0, 5]
    assert samples.winners(path) == best(trials).to_dict("records")


@pytest.mark.parametrize(
    "spoil",
    [
        lambda lines: lines[:6],  # the trials of one search
        lambda lines: [*lines[:-1], lines[-1][:9]],
        lambda lines: [*lines, "3" + lines[-1][1:]],
        lambda lines: [*lines[:-1], lines[-1].replace(".", "x")],
    ],
    ids=["cut off", "cut off in a row", "a further search", "no number"],
)
def test_a_sample_without_a_winner_for_each_search_is_refused(spoil, sample):
    path, _ = sample
    path.write_text("\n".join(spoil(path.read_text().splitlines())) + "\n")
    with pytest.raises(InvalidFile, match="improved_200.csv: it holds no sample"):
        samples.winners(path)


def test_runs_get_the_winners_of_their_searches_and_beyond_the_last_the_first(study, sample):
    path, trials = sample
    learner = build_tuned(rules(study, "improved"), path, [2, 1, 3])
    widths = best(trials)["initial_width"].tolist()
    assert np.ravel(learner.schedule.initial_width).tolist() == [widths[1], widths[0], widths[0]]


SHIPPED = sorted(Path(ROOT, SEARCHED).glob("*.csv"))


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_a_shipped_sample_was_searched_for_what_the_study_trains(study, path):
    assert samples.searched_for(path) == samples.sought(study, path.stem)
    trials, plan_ = samples.read_sample(path), study.search
    numbers = product(range(1, searches(study, path.stem) + 1), range(1, plan_.rounds + 1))
    assert trials.groupby(["search", "round"]).size().to_dict() == dict.fromkeys(
        numbers, plan_.trials
    )
    assert samples.winners(path) == best(trials).to_dict("records")


def test_there_is_a_shipped_sample_for_every_training(study):
    assert {path.stem for path in SHIPPED} == set(Trainings(study).tuned())


def test_all_that_is_compared_has_the_same_budget(study):
    """As many searches at equal iterations; with the same trials and seeds, as files say above."""
    spent = {}
    for name in Trainings(study).tuned():
        spent.setdefault(training(study, name).iterations, set()).add(searches(study, name))
    assert len(spent) > 3
    for iterations, (each,) in spent.items():
        assert each >= (12 if iterations <= 500 else 4)
