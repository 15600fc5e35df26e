"""An effect planted in results with luck as in experiments is found; where there is none, none."""

import numpy as np
import pytest

from recalib.study import statistics
from tests.made_up import FINAL, MadeUp

IMPROVED, SHORT = 0.1, np.array(FINAL["ritter_200"])


@pytest.fixture
def judged(study, tmp_path, monkeypatch):
    """A function that plants how much more error a change brings both systems, and judges it.

    Again and again, each time with other luck of searches and seeds.
    """
    monkeypatch.setattr(statistics, "RESAMPLES", 2000)

    def judged(more: float, repetitions: int) -> list[list[str]]:
        planted = {
            "improved": IMPROVED,
            "improved_theta_values": IMPROVED / more,
            "ritter_200": SHORT,
            "ritter_theta_increments": SHORT * more,
        }
        made_up, verdicts = MadeUp(tmp_path, study, planted), []
        for repetition in range(repetitions):
            for learner in planted:
                made_up.train(learner, repetition)
            claim = made_up.judged("theta-increments")
            by_system = [system["verdict"] for system in claim["systems"].values()]
            verdicts.append([claim["verdict"], *by_system])
        return verdicts

    return judged


def test_a_change_that_is_secretly_none_gets_no_verdict(judged):
    decided = np.array(judged(1.0, 60)) != "undecided"
    assert (decided.mean(axis=0) <= 1 - statistics.LEVEL).all()


def test_half_more_error_is_not_supported(judged):
    assert {*np.ravel(judged(1.5, 10))} == {"not supported"}


def test_half_of_the_error_is_supported(judged):
    assert {*np.ravel(judged(0.5, 10))} == {"supported"}


def test_a_tenth_more_error_is_never_taken_for_less(judged):
    verdicts = np.array(judged(1.1, 20))[:, 1:]
    assert "supported" not in verdicts and "not supported" in verdicts
