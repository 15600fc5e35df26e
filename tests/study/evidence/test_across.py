"""Verdicts over universes, and what they depend on."""

import numpy as np
import pandas as pd
import pytest

from recalib.study.evidence.claims import CLAIMS
from recalib.study.evidence.claims.across import Across, Share, over_all
from recalib.study.evidence.effects import effects

UNIVERSES = 128


def share(holds: int, of: int = UNIVERSES) -> Share:
    return Share(holds, of, pd.Series(dtype=float))


@pytest.mark.parametrize(
    ("home", "holds", "verdict"),
    [
        (True, 120, True),
        (True, 64, None),  # at home alone
        (True, 5, None),
        (None, 120, None),  # nearly everywhere, but not shown at home
        (None, 64, None),
        (None, 30, False),
        (False, 30, False),
        (False, 64, None),
        (False, 120, None),  # elsewhere, but the reverse at home
    ],
)
def test_the_rule_of_verdicts(home, holds, verdict):
    assert over_all(home, share(holds)) is verdict


@pytest.mark.parametrize("home", [True, False, None])
def test_without_universes_home_decides(home):
    assert over_all(home, None) is home


def test_the_interval_of_a_share_is_wilsons():
    low, high = share(64).interval
    assert (low, high) == pytest.approx((0.4147, 0.5853), abs=1e-4)
    assert share(128).interval[1] == 1.0


def test_a_claim_holds_on_its_side_of_the_limit():
    outcomes = pd.DataFrame({"factor": [10.0, 60.0, np.inf]})
    assert list(Across("factor", "", below=False).holds(outcomes, 50)) == [False, True, True]
    assert list(Across("factor", "").holds(outcomes, 50)) == [True, False, False]


def test_claims_name_limits_of_their_own():
    for claim in CLAIMS:
        assert all(across.limit in claim.limits for across in claim.across.values())


def design(random) -> pd.DataFrame:
    half = np.arange(UNIVERSES) % 2
    columns = {"robot": np.arange(UNIVERSES) % 4, "home": random.permutation(half)}
    return pd.DataFrame(columns | {"norm": random.permutation(half)}).astype(str)


def test_the_factor_that_matters_is_found_with_how_much_it_matters():
    random = np.random.default_rng(1)
    factors = design(random)
    values = np.exp(0.2 * random.normal(size=UNIVERSES)) * np.where(factors["home"] == "1", 2, 1)
    table = effects(pd.Series(values), factors, random)
    first = table.iloc[0]
    assert (first["factor"], first["least"], first["largest"]) == ("home", "0", "1")
    assert first["low"] < 2 < first["high"] and first["effect"] > first["chance"]
    assert len(table) == 3 and (table["effect"] / table["chance"]).is_monotonic_decreasing


def test_in_95_percent_no_factor_without_effect_exceeds_chance():
    found = []
    for repetition in range(40):
        random = np.random.default_rng(repetition)
        values = pd.Series(np.exp(random.normal(size=UNIVERSES)))
        table = effects(values, design(random), random)
        found.append((table["effect"] > table["chance"]).any())
    assert np.mean(found) <= 0.1, "four of forty: the binomial's 95 %"


def test_what_was_not_reached_counts_as_twice_the_largest():
    factors = pd.DataFrame({"cells": ["one"] * 4 + ["both"] * 4})
    values = pd.Series([10.0] * 4 + [40.0, 40.0, np.inf, np.inf])
    first = effects(values, factors, np.random.default_rng(0)).iloc[0]
    assert first["effect"] == pytest.approx(4 * np.sqrt(2))
