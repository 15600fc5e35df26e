"""From table to verdict, in worlds whose truth is planted: coverage, error rates and power."""

from collections import Counter
from typing import NamedTuple

import numpy as np
import pytest

from replication.judgement import RATIO, Comparison, Verdict, model

pytestmark = pytest.mark.slow  # thousands of campaigns; of code whose digests are registered
SETUPS, REPLICATED, NOISE = 30, 6, 0.015
MANY, FEW = 500, 100  # worlds: for a coverage to 2 %; for a power of more than 80 %
NAMES = "mean", "another", "heterogeneity", "luck"


class Result(NamedTuple):
    covered: dict[str, float]
    verdicts: Counter


def analysed(mean, between, comparison=RATIO, ends=np.inf, worlds=MANY) -> Result:
    """A campaign in each world; values above `ends` are bounds, as at the end of a ladder."""
    rng = np.random.default_rng([int(1e6 * (10 + mean + between)), 44])
    covered, verdicts = Counter(), Counter()
    for _ in range(worlds):
        own = mean + between * rng.normal(size=SETUPS + 1)
        values = np.full((SETUPS, 2), np.nan)
        values[:, 0] = own[:-1] + NOISE * rng.normal(size=SETUPS)
        values[:REPLICATED, 1] = own[:REPLICATED] + NOISE * rng.normal(size=REPLICATED)
        beyond = values > ends
        found = model(np.where(beyond, ends, values), beyond.astype(int))
        truth = mean, own[-1] + NOISE * rng.normal(), between, NOISE
        for name, true in zip(NAMES, truth, strict=True):
            estimate = getattr(found, name)
            covered[name] += estimate.low <= true <= estimate.high
        verdicts[comparison.verdict(found)] += 1
    return Result({name: covered[name] / worlds for name in NAMES}, verdicts)


def share(result, *verdicts):
    return sum(result.verdicts[verdict] for verdict in verdicts) / result.verdicts.total()


FALSE = Verdict.SUPPORTED, Verdict.CONTRADICTED
BETWEEN = (0.05, 0.15)


@pytest.fixture(scope="module")
def nulls():
    return {between: analysed(0.0, between) for between in BETWEEN}


@pytest.fixture(scope="module")
def wide():
    return analysed(np.log(1.2), 0.4)


def test_a_null_is_called_no_effect_and_one_that_crosses_the_limit_depends(nulls):
    for result in nulls.values():
        assert share(result, *FALSE) <= 0.01
        assert share(result, Verdict.NO_EFFECT) >= 0.8
    assert share(analysed(0.0, 0.4, worlds=FEW), Verdict.DEPENDS) >= 0.8
    assert share(analysed(np.log(0.05), 0.4, worlds=FEW), Verdict.SUPPORTED) >= 0.95


@pytest.mark.parametrize("between", [0.0, *BETWEEN])
def test_an_effect_of_20_percent_is_found(between):
    assert share(analysed(np.log(0.8), between, worlds=FEW), Verdict.SUPPORTED) >= 0.8
    assert share(analysed(np.log(1.25), between, worlds=FEW), Verdict.CONTRADICTED) >= 0.8


def test_intervals_cover(nulls, wide):
    results = [*nulls.values(), wide]
    for result in results:
        assert all(0.92 <= coverage <= 0.98 for coverage in result.covered.values()), result.covered
    every = [coverage for result in results for coverage in result.covered.values()]
    assert 0.94 <= np.mean(every) <= 0.96


def test_intervals_cover_if_ladders_end_early():
    """The ladder ends 1.2 deviations above the mean: at one setup in nine."""
    long = Comparison(np.log(50), below=False)
    result = analysed(np.log(100), 0.5, long, ends=np.log(100) + 0.6)
    assert 0.92 <= result.covered["mean"] <= 0.98
    assert 0.92 <= result.covered["another"] <= 0.98
    assert share(result, Verdict.SUPPORTED) >= 0.9
