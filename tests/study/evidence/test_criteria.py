"""Limits are those that were written: to change one is to change it here."""

import numpy as np
import pandas as pd
import pytest

from recalib.study.evidence.claims import CLAIMS
from recalib.study.evidence.claims.across import Across, Share, over_all
from recalib.study.evidence.claims.claim import above, below, every, somewhere, verdict
from recalib.study.statistics import Estimate

LIMITS = {
    "identity": {"error": 0.001},  # cm, degrees
    "ritter-slow": {"left": 0.25},
    "weak-coupling": {"ratio": 0.1, "poses": 0.95},
    "separate-maps": {"ratio": 1},
    "width-order": {"ratio": 1, "best": 0.1},
    "theta-increments": {"ratio": 1},
    "theta-reason": {"integrals": 1},
    "jacobian-increments": {"ratio": 1},
    "jacobian-reason": {"integrals": 1},
    "expected-learning": {"deviation": 0.05, "errors": 3, "away": 3},
    "schedule": {"ratio": 1},
    "rigid": {"left": 0.05, "zero": 0.01},
    "initial-error": {"tail": 0.025},
    "figure-1": {"left": 0.1},
    "speed-up": {"factor": 50},
    "rough-search": {"share": 0.1, "factor": 2},
    "controller-kept": {"difference": 0},
}


def test_limits_are_as_they_were_written():
    assert {claim.id: dict(claim.limits) for claim in CLAIMS} == LIMITS
    assert [claim.id for claim in CLAIMS] == [*LIMITS], "in the order of the paper"


def test_in_a_universe_a_claim_holds_on_the_same_side_of_the_same_limit_as_at_home():
    larger = {"ritter-slow", "speed-up"}
    for claim in CLAIMS:
        for across in claim.across.values():
            limit, outcomes = claim.limits[across.limit], pd.DataFrame({across.column: [0.0] * 3})
            outcomes[across.column] = [limit * 0.9, limit, limit * 1.1]
            expected = [False, False, True] if claim.id in larger else [True, False, False]
            assert across.holds(outcomes, limit).tolist() == expected


@pytest.mark.parametrize(
    ("low", "high", "is_below", "is_above"),
    [
        (0.5, 0.9, True, False),
        (1.1, 2.0, False, True),
        (0.5, 2.0, None, None),
        (0.5, 1.0, None, None),  # a bound at the limit decides nothing
        (1.0, 2.0, None, None),
        (np.nan, np.nan, None, None),
    ],
)
def test_a_whole_interval_decides(low, high, is_below, is_above):
    found = Estimate(1.0, low, high)
    assert (below(found, 1.0), above(found, 1.0)) == (is_below, is_above)


@pytest.mark.parametrize(
    ("judged", "all_hold", "one_holds"),
    [
        ([True, True], True, True),
        ([True, None], None, True),
        ([True, False], False, None),
        ([False, None], False, False),
        ([False, False], False, False),
        ([None, None], None, None),
    ],
)
def test_several_judgements_are_one(judged, all_hold, one_holds):
    assert every(iter(judged)) is all_hold
    assert somewhere(iter(judged)) is one_holds


def test_a_verdict_is_a_word():
    words = [verdict(holds) for holds in (True, False, None)]
    assert words == ["supported", "not supported", "undecided"]


def shared(holds: int) -> Share:
    its = {"factor": "home", "least": 1, "largest": 2, "effect": 1.23456, "low": 1.1, "high": 1.4}
    return Share(holds, 128, pd.Series(its | {"chance": 1.3}))


@pytest.mark.parametrize(
    ("home", "holds", "over"),
    [
        (True, 128, True),
        (True, 76, True),  # Wilson's interval of 76 of 128 begins above a half, that of 75 at it
        (True, 75, None),
        (True, 40, None),
        (None, 40, False),
        (False, 52, False),
        (False, 53, None),
        (None, 100, None),
        (False, 128, None),
    ],
)
def test_a_claim_holds_over_all_universes_by_the_rule(home, holds, over):
    assert over_all(home, shared(holds)) is over
    assert over_all(home, None) is home


def test_a_share_has_wilsons_interval_and_says_what_moves_it_most():
    z, n, p = 1.959964, 128, 40 / 128
    middle = (p + z**2 / (2 * n)) / (1 + z**2 / n)
    half = z * np.sqrt(p * (1 - p) / n + z**2 / (4 * n**2)) / (1 + z**2 / n)
    share = shared(40)
    assert share.interval == pytest.approx((middle - half, middle + half), abs=1e-6)
    said = share.said
    assert (said["holds"], said["of"]) == (40, 128)
    assert said["interval"] == pytest.approx(share.interval, rel=1e-3)
    moves = {"factor": "home", "from": "1", "to": "2", "times": 1.235, "interval": [1.1, 1.4]}
    assert said["depends_on"] == moves | {"chance": 1.3}
    assert Across("a", "b").limit == "ratio" and Across("a", "b").below
