"""Numbers of a contrast, beside what one computes by hand."""

import numpy as np
import pandas as pd
import pytest

from replication.judgement import Compromise, Contrast, Crossing, Difference, Remaining, crossing

ONE, TWO = Remaining("one", 200), Remaining("two", 200)


def outcomes(rows) -> pd.DataFrame:
    """Rows of setup, replicate, variant, iterations, both shares."""
    columns = ["setup", "replicate", "variant", "iterations", "position_share", "orientation_share"]
    return pd.DataFrame(rows, columns=columns).assign(settled=1)


TABLE = outcomes(
    [
        (0, 0, "one", 200, 0.1, 0.3),
        (0, 0, "two", 200, 0.6, 0.2),
        (0, 1, "one", 200, 0.2, 0.1),
        (0, 1, "two", 200, 0.1, 0.1),
        (1, 0, "one", 200, 0.5, 0.4),
        (1, 0, "two", 200, 0.1, 0.2),
        (0, 0, "one", 1000, 9, 9),
    ]
)


def numbers(values):
    return np.exp(values.table.to_numpy())


def test_the_larger_share_counts_unless_one_error_is_asked_for():
    expected = np.array([[0.3, 0.2], [0.5, np.nan]])
    assert numbers(ONE.values(TABLE)) == pytest.approx(expected, nan_ok=True)
    position = Remaining("one", 200, "position").values(TABLE)
    assert numbers(position)[0] == pytest.approx([0.1, 0.2])


def test_a_contrast_is_a_ratio_in_the_same_setup_and_replicate_a_difference_one_of_ratios():
    found = Contrast(ONE, TWO).values(TABLE)
    assert numbers(found) == pytest.approx(np.array([[0.5, 2], [2.5, np.nan]]), nan_ok=True)
    assert not found.bounds.to_numpy().any()
    double = Contrast(ONE, TWO)
    nothing = Difference(double, double).values(TABLE)
    assert numbers(nothing) == pytest.approx(np.array([[1, 1], [1, np.nan]]), nan_ok=True)
    other = Difference(double, Contrast(TWO, ONE)).values(TABLE)
    assert numbers(other)[0, 0] == pytest.approx(0.25)


def test_a_compromise_is_compared_with_the_larger_share_of_both_tuned_alone():
    alone = Remaining("one", 200, "position"), Remaining("two", 200, "orientation")
    found = Compromise(TWO, *alone).values(TABLE)
    assert numbers(found)[0, 0] == pytest.approx(0.6 / 0.2)  # of 0.1 and 0.2


def test_searches_that_have_not_converged_are_counted_in_all_that_is_compared():
    table = TABLE.assign(settled=[0, 0, 1, 1, 1, 1, 0])
    assert ONE.values(table).unsettled == 1
    assert Contrast(ONE, TWO).values(table).unsettled == 2


LADDER = [
    *(
        (0, 0, "slow", iterations, share, 0.01)
        for iterations, share in ((200, 0.9), (2000, 0.3), (20_000, 0.03))
    ),
    (0, 0, "one", 200, 0.1, 0.02),
]


def test_a_factor_is_interpolated_between_two_lengths_on_logarithmic_scales():
    found = Crossing("slow", ONE).values(outcomes(LADDER))
    part = np.log(3) / np.log(10)
    assert numbers(found)[0, 0] == pytest.approx(10 ** (1 + part))
    assert found.bounds.to_numpy().tolist() == [[0]]


@pytest.mark.parametrize("goal, factor, bound", [(0.02, 100, 1), (0.95, 1, -1), (0.03, 100, 0)])
def test_where_a_ladder_ends_the_factor_is_a_bound(goal, factor, bound):
    rows = [*LADDER[:-1], (0, 0, "one", 200, goal, 0.01)]
    found = Crossing("slow", ONE).values(outcomes(rows))
    assert numbers(found)[0, 0] == pytest.approx(factor)
    assert found.bounds.to_numpy().tolist() == [[bound]]


def test_the_first_crossing_counts():
    lengths = np.log([1.0, 2, 4, 8])
    assert crossing(lengths, np.array([1.0, -1, 1, -1])) == (pytest.approx(np.log(2) / 2), 0)
