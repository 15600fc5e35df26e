"""Each rule of docs/registration.md, as cases."""

from itertools import combinations

import numpy as np
import pytest

from replication.judgement import (
    RATIO,
    Comparison,
    Estimate,
    Model,
    Verdict,
    of_published,
    of_share,
    share_interval,
)

YES, NO, NONE, DEPENDS, UNDECIDED = Verdict
TENTH = Comparison(np.log(0.1))


def interval(low, high) -> Estimate:
    low, high = np.log([low, high])
    return Estimate((low + high) / 2, low, high)


def over_setups(mean, heterogeneity) -> Model:
    return Model(mean, mean, heterogeneity, Estimate(0.1, 0.1, 0.1), np.zeros(30))


@pytest.mark.parametrize(
    ("comparison", "low", "high", "verdict"),
    [
        (RATIO, 0.5, 0.9, YES),
        (RATIO, 0.8, 0.99, YES),  # in part nearer to 1 than 10 %; its mean is not
        (RATIO, 1.01, 2.0, NO),
        (RATIO, 0.92, 0.99, NONE),  # equivalence comes first
        (RATIO, 0.92, 1.09, NONE),
        (RATIO, 0.86, 0.99, UNDECIDED),  # an effect, but a small one
        (RATIO, 1.01, 1.15, UNDECIDED),
        (RATIO, 0.92, 1.11, UNDECIDED),
        (RATIO, 0.8, 1.0, UNDECIDED),  # an end at the limit holds it
        (RATIO, 1.0, 1.3, UNDECIDED),
        (RATIO, 0.8, 1.2, UNDECIDED),
        (TENTH, 0.01, 0.09, YES),
        (TENTH, 0.11, 0.2, NO),
        (TENTH, 0.099, 0.101, UNDECIDED),  # no bounds of equivalence, however narrow
        (TENTH, 0.05, 0.1, UNDECIDED),
    ],
)
def test_a_number_is_judged_by_its_whole_interval(comparison, low, high, verdict):
    assert comparison.of_interval(interval(low, high)) is verdict


MIRRORED = {YES: NO, NO: YES, NONE: NONE, UNDECIDED: UNDECIDED}
ENDS = combinations(np.exp(np.linspace(-0.31, 0.31, 13)), 2)


def test_what_a_positive_verdict_needs_a_negative_one_needs():
    """A ratio turned upside down, and the other side."""
    found = set()
    for low, high in ENDS:
        verdict = RATIO.of_interval(interval(low, high))
        assert RATIO.of_interval(interval(1 / high, 1 / low)) is MIRRORED[verdict]
        other = RATIO._replace(below=False)
        assert other.of_interval(interval(low, high)) is MIRRORED[verdict]
        found.add(verdict)
    assert found == {*MIRRORED}


@pytest.mark.parametrize(
    ("between", "verdict"),
    [
        ((0.4, 0.3, 0.5), DEPENDS),  # 0.7 of the setups lie within a factor of 1.5 of one
        ((0.4, 0.1, 0.7), NONE),  # it may be small
        ((0.1, 0.05, 0.15), NONE),
    ],
)
def test_where_setups_differ_and_none_prevails_it_depends(between, verdict):
    model = over_setups(interval(0.95, 1.05), Estimate(*between))
    assert RATIO.verdict(model) is verdict


def test_where_nearly_all_setups_agree_the_mean_decides_and_shares_have_intervals():
    model = over_setups(interval(0.3, 0.4), Estimate(0.4, 0.3, 0.5))
    assert RATIO.verdict(model) is YES
    shares = RATIO.shares(model)
    assert sum(shares.values()) == pytest.approx(1) and shares[YES] > 0.98
    assert share_interval(24, 30) == pytest.approx((0.6143, 0.9229), abs=1e-4)
    assert share_interval(0, 10) == pytest.approx((0, 0.3085), abs=1e-4)
    assert share_interval(10, 10) == pytest.approx((0.6915, 1), abs=1e-4)


@pytest.mark.parametrize(
    ("low", "high", "verdict"),
    [
        (50, 90, YES),
        (60, 70, YES),  # an end of the interval is in it
        (25, 99, YES),
        (24, 100, UNDECIDED),  # more than four times
        (1, 1000, UNDECIDED),
        (71, 500, NO),
        (10, 69, NO),
    ],
)
def test_a_published_number_is_compared_with_an_interval(low, high, verdict):
    assert of_published(np.log(70), interval(low, high)) is verdict


@pytest.mark.parametrize(
    ("holds", "setups", "verdict"),
    [(30, 30, YES), (5, 5, UNDECIDED), (29, 30, DEPENDS), (15, 30, NO), (0, 30, NO)],
)
def test_a_claim_about_every_setup_holds_in_all_of_many(holds, setups, verdict):
    assert of_share(holds, setups) is verdict
