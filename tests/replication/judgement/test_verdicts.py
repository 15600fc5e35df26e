"""Each rule of docs/registration.md, as cases."""

from itertools import product
from math import inf, nan

import numpy as np
import pytest

from replication.judgement.intervals import Estimate
from replication.judgement.verdicts import CORRELATION, RATIO, Comparison, Verdict, of_published

SUPPORTED, CONTRADICTED, NONE, UNDECIDED = Verdict
TENTH = Comparison(0.1)


def interval(low, high) -> Estimate:
    return Estimate((low + high) / 2, low, high)


def test_a_verdict_is_a_word():
    words = ["supported", "contradicted", "no effect", "undecided"]
    assert [str(each) for each in Verdict] == words


@pytest.mark.parametrize(
    ("comparison", "low", "high", "verdict"),
    [
        (RATIO, 0.5, 0.9, SUPPORTED),
        (RATIO, 0.5, 0.999, SUPPORTED),  # partly within bounds, all of it below 1
        (RATIO, 1.001, 2.0, CONTRADICTED),
        (RATIO, 0.92, 0.99, NONE),  # equivalence comes first
        (RATIO, 0.92, 1.09, NONE),
        (RATIO, 1 / 1.1, 1.09, UNDECIDED),  # an end at a bound is not between them
        (RATIO, 0.92, 1.1, UNDECIDED),
        (RATIO, 0.8, 1.0, UNDECIDED),  # an end at the limit holds it
        (RATIO, 1.0, 1.2, UNDECIDED),
        (RATIO, 0.8, 1.2, UNDECIDED),
        (RATIO, nan, nan, UNDECIDED),
        (CORRELATION, 0.05, 0.2, SUPPORTED),
        (CORRELATION, -0.2, -0.05, CONTRADICTED),
        (CORRELATION, -0.09, 0.09, NONE),
        (CORRELATION, 0.01, 0.09, NONE),
        (CORRELATION, -0.1, 0.09, UNDECIDED),
        (CORRELATION, -0.05, 0.2, UNDECIDED),
        (CORRELATION, nan, nan, UNDECIDED),
        (TENTH, 0.01, 0.09, SUPPORTED),
        (TENTH, 0.11, 0.2, CONTRADICTED),
        (TENTH, 0.099, 0.101, UNDECIDED),  # no bounds of equivalence, however narrow
        (TENTH, 0.05, 0.1, UNDECIDED),
        (TENTH, nan, nan, UNDECIDED),
    ],
)
def test_a_number_is_judged_by_its_whole_interval(comparison, low, high, verdict):
    """A ratio, a correlation, and what has a limit without bounds of equivalence."""
    assert comparison.verdict(interval(low, high)) == verdict


MIRRORED = {SUPPORTED: CONTRADICTED, CONTRADICTED: SUPPORTED, NONE: NONE, UNDECIDED: UNDECIDED}
ENDS = [
    (low, high) for low, high in product(np.exp(np.linspace(-0.3, 0.3, 13)), repeat=2) if low < high
]


def test_what_a_positive_verdict_needs_a_negative_one_needs():
    """A ratio turned upside down, a correlation with the other sign, and the other side."""
    found = set()
    for low, high in ENDS:
        verdict = RATIO.verdict(interval(low, high))
        assert RATIO.verdict(interval(1 / high, 1 / low)) == MIRRORED[verdict]
        other = Comparison(RATIO.limit, not RATIO.below, RATIO.bounds)
        assert other.verdict(interval(low, high)) == MIRRORED[verdict]
        low, high = np.log([low, high])
        verdict = CORRELATION.verdict(interval(low, high))
        assert CORRELATION.verdict(interval(-high, -low)) == MIRRORED[verdict]
        found.add(verdict)
    assert found == {*Verdict}


LOW, WITHIN, HIGH = interval(0.5, 0.8), interval(0.95, 1.05), interval(1.2, 2.0)
UNSURE = interval(0.5, 2.0)


@pytest.mark.parametrize(
    ("mean", "reference", "verdict"),
    [
        (LOW, LOW, SUPPORTED),
        (LOW, UNSURE, SUPPORTED),
        (LOW, WITHIN, SUPPORTED),
        (LOW, interval(1.01, 1.05), UNDECIDED),  # on the other side, if within the bounds
        (LOW, HIGH, UNDECIDED),
        (HIGH, HIGH, CONTRADICTED),
        (HIGH, UNSURE, CONTRADICTED),
        (HIGH, LOW, UNDECIDED),
        (WITHIN, LOW, NONE),
        (WITHIN, HIGH, NONE),
        (UNSURE, LOW, UNDECIDED),
        (LOW, interval(nan, nan), SUPPORTED),
        (interval(nan, nan), LOW, UNDECIDED),
    ],
)
def test_over_all_setups_the_mean_decides_unless_the_reference_study_says_the_opposite(
    mean, reference, verdict
):
    assert RATIO.over_all(mean, reference) == verdict


@pytest.mark.parametrize(
    ("low", "high", "verdict"),
    [
        (50, 90, SUPPORTED),
        (70, 80, SUPPORTED),  # an end of the interval is in it
        (60, 70, SUPPORTED),
        (25, 100, SUPPORTED),  # four times, and not more
        (24, 100, UNDECIDED),
        (50, inf, UNDECIDED),  # a bound at the end of a ladder
        (0, 100, UNDECIDED),
        (71, inf, CONTRADICTED),
        (10, 69, CONTRADICTED),
        (0, 1, CONTRADICTED),
        (nan, nan, UNDECIDED),
        (nan, 50, UNDECIDED),
        (80, nan, UNDECIDED),
    ],
)
def test_a_published_number_is_compared_with_an_interval(low, high, verdict):
    assert of_published(70, interval(low, high)) == verdict
