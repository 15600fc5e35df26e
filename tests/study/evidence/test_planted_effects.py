"""An effect planted in results with luck as in experiments is found; where there is none, none."""

import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from recalib.study import statistics
from recalib.study.evidence import effects
from recalib.study.layout import DESIGN, OUTCOMES
from tests.conftest import ROOT
from tests.made_up import FINAL, MadeUp

IMPROVED, SHORT = 0.1, np.array(FINAL["ritter_200"])
OF_UNIVERSES = 0.3  # spread of logarithmic ratios: 0.07 to 0.31 for changes that matter little


@pytest.fixture
def judged(study, tmp_path, monkeypatch):
    """A function that plants how much more error a change brings both systems, and judges it.

    Again and again, each time with other luck of searches, seeds and universes.
    """
    monkeypatch.setattr(statistics, "RESAMPLES", 2000)
    monkeypatch.setattr(effects, "RESAMPLES", 20)
    monkeypatch.chdir(tmp_path)  # where no universe was measured

    def measure_universes(more: float, repetition: int, count: int) -> None:
        luck = OF_UNIVERSES * np.random.default_rng(repetition).normal(size=(count, 2))
        names = ["theta_improved", "theta_ritter"]
        pd.DataFrame(more * np.exp(luck), columns=names).to_csv(OUTCOMES)

    def judged(more: float, repetitions: int, universes: bool = False) -> list[list[str]]:
        planted = {
            "improved": IMPROVED,
            "improved_theta_values": IMPROVED / more,
            "ritter_200": SHORT,
            "ritter_theta_increments": SHORT * more,
        }
        made_up, verdicts = MadeUp(tmp_path, study, planted), []
        if universes:
            Path(DESIGN).parent.mkdir(parents=True)
            count = len(pd.read_csv(shutil.copy(ROOT / DESIGN, DESIGN)))
        for repetition in range(repetitions):
            for learner in planted:
                made_up.train(learner, repetition)
            if universes:
                measure_universes(more, repetition, count)
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


def test_a_tenth_more_error_at_home_is_never_taken_for_less(judged):
    verdicts = np.array(judged(1.1, 20))[:, 1:]
    assert "supported" not in verdicts and "not supported" in verdicts


def test_a_change_that_is_none_in_any_universe_gets_no_verdict(judged):
    decided = np.array(judged(1.0, 60, universes=True)) != "undecided"
    assert (decided.mean(axis=0) <= 1 - statistics.LEVEL).all()


@pytest.mark.parametrize(("more", "verdict"), [(1.1, "not supported"), (0.9, "supported")])
def test_a_tenth_of_the_error_is_seen_over_all_universes(judged, more, verdict):
    by_system = np.array(judged(more, 20, universes=True))[:, 1:]
    assert {*by_system.ravel()} <= {verdict, "undecided"}
    assert np.mean(by_system == verdict) > 0.8
