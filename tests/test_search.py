import numpy as np
import pandas as pd
import pytest

from recalib.errors import InvalidSetting, UnknownName
from recalib.learners.hierarchical import Rules
from recalib.study.experiments import search, tuned

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


def test_a_training_is_a_learner_and_its_iterations(config):
    learners = config["learners"]
    assert tuned.training("ritter", learners) == ("ritter", 10_000)
    assert tuned.training("ritter_200", learners) == ("ritter", 200)
    assert tuned.training("ritter_double", learners) == ("ritter_double", 10_000)
    assert str(tuned.training("ritter_200", learners)) == "ritter_200"
    for wrong in ("riter", "ritter_0", "ritter_-5", "ritter_2x"):
        with pytest.raises(UnknownName, match="improved.*ritter_ITERATIONS"):
            tuned.training(wrong, learners)


def test_a_training_without_settings_is_refused_with_what_to_do(config, tmp_path):
    (tmp_path / "settings.yaml").write_text("improved_200: {initial_width: 1}\n")
    with pytest.raises(InvalidSetting, match=r"ritter_77.*improved_200.*snakemake --cores 2 tune"):
        tuned.settings(tuned.training("ritter_77", config["learners"]), tmp_path)


def test_rules_are_what_the_configuration_says(config):
    assert tuned.rules(config["learners"]["improved"]) == Rules(True, True, True, True)
    assert tuned.rules(config["learners"]["ritter"]) == Rules(False, False, False, False)
    assert tuned.rules(config["learners"]["ritter_double"]).supernet == (3, 6, 3)
