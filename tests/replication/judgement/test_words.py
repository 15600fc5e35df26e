"""What pages say of numbers and claims, word for word."""

from functools import partial

import numpy as np
import pytest

from replication.config.shipped import FACTORS
from replication.config.values import from_file
from replication.judgement.intervals import Estimate
from replication.training.measured import ERRORS
from replication.pages import words
from tests.conftest import ROOT


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0.00"),
        (0.694, "0.69"),
        (12.5, "12.50"),
        (0.01, "0.01"),
        (0.00994, "9.9e-03"),
        (-0.004, "-4.0e-03"),
        (1.1e-6, "1.1e-06"),
        (9.9e-7, "below 1e-6"),
        (-3e-12, "below 1e-6"),
    ],
)
def test_a_number_has_two_digits_and_what_rounding_leaves_none(value, text):
    assert words.n(value) == text


def test_digits_may_be_asked_for():
    assert words.n(1.26, 1) == "1.3" and words.n(0.04, 1) == "4.0e-02" and words.n(2.6, 0) == "3"


def test_a_pair_is_both_errors_with_their_units():
    row = {f"final_{error}": value for error, value in zip(ERRORS, (0.126, 3e-9), strict=True)}
    assert words.pair(row, "final") == "0.13 cm, below 1e-6 degrees"


def setups(effect=1.5, **others):
    its = {"factor": "cells", "from": "each", "to": "whole", "effect": effect, "chance": 1.2}
    return {
        "status": "measured",
        "setups": 64,
        "setups_left_out": 0,
        "mean": 0.9,
        "mean_interval": [0.85, 0.95],
        "heterogeneity": 0.05,
        "heterogeneity_interval": [0.0, 0.1],
        "luck": 0.2,
        "luck_interval": [0.18, 0.22],
        "another_setup": [0.8, 1.0],
        "depends_on": its | {"interval": [1.32, 1.78]},
    } | others


OF_ONE = {
    "id": "some",
    "verdict": "supported",
    "measured": {"factor": 100.0, "difference": 2e-8, "final error [cm]": 0.3149}
    | {"final error [degrees]": 0.2},
    "interval": {"factor": [40.6, 100.0], "difference": [0.0, 1e-7]},
    "bounds": {"factor": ["mean", "high"]},
    "universes": setups(),
    "systems": {"ours": {"verdict": "supported", "universes": setups()}},
}
OF_TWO = OF_ONE | {
    "verdict": "no effect",
    "systems": {
        "ours": {"verdict": "no effect", "universes": setups()},
        "Ritter's": {"verdict": "undecided", "universes": setups()},
        "others": {"verdict": "no effect", "universes": setups()},
    },
}


def test_what_was_measured_is_said_with_its_interval_and_bounds_are_called_so():
    factor = "factor: at least 100 (40.6 to at least 100)"
    assert words.measured(OF_ONE) == (
        f"{factor}; difference: below 1e-6 (0 to below 1e-6);"
        " final error [cm]: 0.315; final error [degrees]: 0.2"
    )
    assert words.typical_errors(OF_ONE) == "0.31 cm and 0.20 degrees"


def test_the_setups_judge_a_claim_where_they_are_measured():
    assert words.headline(OF_ONE) == "0.9 (0.85 to 0.95)"
    assert words.headline(OF_ONE, words.percent) == "90 % (85 % to 95 %)"
    alone = OF_ONE | {"universes": {"status": "cannot vary"}}
    assert words.headline(alone) == "at least 100 (40.6 to at least 100)"
    assert words.headline(OF_ONE | {"id": "speed-up"}) == words.headline(alone)


def test_a_verdict_is_said_of_other_systems_where_they_differ():
    assert words.verdicts(OF_ONE) == "**supported**"
    assert words.verdicts(OF_TWO) == "**no effect** (ours); Ritter's: undecided"
    assert words.verdicts(OF_ONE | {"systems": {}}) == "**supported**"


def test_setups_are_said_by_mean_heterogeneity_and_luck():
    text = "0.9 (0.85 to 0.95); heterogeneity 0.05 (0 to 0.1), luck 0.2, another setup 0.8 to 1"
    assert words.over_setups(setups()) == text
    counted = setups(holds=60, holds_by_luck_alone=61.24)
    held = "; holds in 60 of 64 (61.2 expected from luck alone)"
    assert words.over_setups(counted) == text + held
    some = words.over_setups(setups(setups=30, setups_left_out=2))
    assert some == f"{text}; known in 30 of 32"


depends = partial(words.depends, from_file(ROOT / FACTORS).plain())


def test_a_choice_is_said_to_matter_where_it_matters_more_than_chance():
    text = (
        " Largest effect: 1.5 (1.32 to 1.78) where Ritter's net has as many cells as both maps,"
        " not one map."
    )
    assert depends(setups()) == text
    assert depends(setups(1.2)) == ""


def test_an_estimate_is_said_with_its_interval_and_the_end_of_what_was_tried():
    nan = float("nan")
    assert words.estimated(Estimate(33.24, 20.1, 38.9)) == "33.2 (20.1 to 38.9)"
    assert words.estimated(Estimate(90, 80, np.inf), 100) == "90 (80 to more than 100)"
    assert words.estimated(Estimate(2.0, nan, nan)) == "2"
    assert words.estimated(Estimate(2.0, nan, 3.0)) == "2", "half an interval is none"
    assert words.estimated(Estimate(nan, nan, nan)) == "not known"


def test_a_damage_is_its_amounts():
    entry = {"link": "forearm_link", "shorten": "4 cm", "rotate": ["1 deg", "0 deg"]}
    assert words.amounts(entry) == "forearm_link 4 cm 1 deg, 0 deg"
