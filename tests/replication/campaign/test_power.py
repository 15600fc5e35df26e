"""The power study: what it counts in worlds of its own, and what the committed one promises."""

import pandas as pd
import pytest

from replication.campaign import power as module
from replication.campaign.power import power
from replication.config.shipped import POWER
from replication.judgement.verdicts import Verdict
from tests.conftest import ROOT

WORDS = [str(each) for each in Verdict]


def test_worlds_that_are_clear_are_judged_so(monkeypatch):
    monkeypatch.setattr(module, "ASSUMED_LUCK", {"full": 0.05, "rough": 0.1})
    monkeypatch.setattr(module, "EFFECTS", (1.0, 0.5))
    monkeypatch.setattr(module, "HETEROGENEITIES", (0.0, 1.0))
    table = power(32, 2, studies=6).set_index(["effect", "heterogeneity"])
    assert table[WORDS].sum(axis=1).tolist() == [1.0] * 4
    assert table.loc[(1.0, 0.0), "no effect"] == table.loc[(0.5, 0.0), "supported"] == 1
    assert table.loc[(1.0, 1.0), "found"] == 1 and table.loc[(1.0, 1.0), "no effect"] == 0
    assert power(32, 2, studies=2).equals(power(32, 2, studies=2))


@pytest.fixture(scope="module")
def committed() -> pd.DataFrame:
    return pd.read_csv(ROOT / POWER)


def test_the_campaign_calls_equal_what_is_equal_and_finds_a_tenth(committed):
    same = committed.query("heterogeneity == 0").set_index("effect")
    assert same.loc[1.0, "supported"] + same.loc[1.0, "contradicted"] <= 0.05
    assert same.loc[1.0, "no effect"] >= 0.8
    assert same.loc[0.9, "supported"] >= 0.8


def test_its_intervals_hold_the_truth_in_95_percent(committed):
    """Of a heterogeneity of zero, an interval that begins there misses less."""
    for part in ("mean", "luck"):
        assert committed[f"{part}_covered"].between(0.93, 0.97).all(), part
    there = committed.query("heterogeneity > 0")
    assert there["heterogeneity_covered"].between(0.93, 0.97).sum() >= 3
    assert committed["heterogeneity_covered"].between(0.93, 0.99).all()
