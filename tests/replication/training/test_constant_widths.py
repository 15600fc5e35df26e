"""When both errors are halved, with widths and rates that stay as they are."""

import numpy as np
import pytest

from replication.training import Stream, rules_of
from replication.training import constant_widths as its

RUNS, ITERATIONS = 3, 40


@pytest.fixture
def improved(study):
    return rules_of(study.learners["improved"])


def halved_after(resolved, improved, rate: float, width: float = 1.0) -> np.ndarray:
    poses = Stream.WIDTHS.draw(7, range(RUNS), ITERATIONS, 20)
    rates = np.full(RUNS, rate)
    return its.halved_after(resolved, improved, width, rates, poses, 7)


def test_who_hardly_learns_is_not_said_to_have_halved_anything(uneven, improved):
    assert (halved_after(uneven, improved, 1e-6) == ITERATIONS).all()


def test_wide_neighbourhoods_halve_both_errors_soon_and_narrow_ones_late(uneven, improved):
    wide = halved_after(uneven, improved, 0.8)
    assert (wide > 0).all() and (wide < ITERATIONS / 2).all()
    assert (halved_after(uneven, improved, 0.8, its.WIDTHS["narrow"]) > wide).all()


def test_each_width_gets_the_better_of_two_rates(uneven, improved, monkeypatch):
    monkeypatch.setattr(its, "ITERATIONS", ITERATIONS)
    monkeypatch.setattr(its, "SEEDS", 2)
    monkeypatch.setattr(its, "RATES", np.array([0.8, 1e-6]))
    table = its.constant_widths(uneven, improved, 7)
    assert table["rate"].tolist() == [0.8] * 4
    assert table["seed"].tolist() == [0, 1] * 2
