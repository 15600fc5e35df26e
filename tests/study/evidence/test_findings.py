"""What the page of findings says; that it is written as the claims have it, other tests show."""

from types import SimpleNamespace

import pandas as pd
import pytest

from recalib.study.configuration.shipped import DESIGN, POWER
from recalib.study.evidence.claims import CLAIMS
from recalib.study.evidence.findings import (
    _campaign,
    _refused,
    _said,
)


def test_refused_moves_are_said_by_learner_and_scenario_and_none_is_said_as_none():
    summary = pd.DataFrame(
        {
            "scenario": ["intact", "gears"],
            "learner": ["improved", "ritter"],
            "moves": [400, 400],
            "seeds": [5, 5],
            "refused": [0, 3],
        }
    )
    assert _refused(summary) == "3 of 2,000 for ritter on gears"
    assert _refused(summary[:1]) == "none"


def test_the_power_of_the_campaign_is_read_from_its_table():
    effects, own = (1.0, 0.95, 0.9), (0.0, 0.1, 0.2, 0.3)
    rows = [
        {
            "effect": effect,
            "heterogeneity": spread,
            "supported": {1.0: 0.01, 0.95: 0.5, 0.9: 0.99}[effect] - 0.5 * (spread > 0),
            "found": {0.0: 0.03, 0.1: 0.7, 0.2: 0.9, 0.3: 0.95}[spread],
        }
        for effect in effects
        for spread in own
    ]
    evidence = SimpleNamespace(
        setups=lambda table: pd.DataFrame({"universe": [0, 0, 1, 1], "replicate": [0, 1, 0, 1]}),
        table={POWER: pd.DataFrame(rows), DESIGN: pd.DataFrame({"homes_refused": [2, 3]})}.get,
        levels=lambda: pd.DataFrame({"one": [1, 2], "two": [1, 2]}),
    )
    said = _campaign(evidence)
    assert (said["setups"], said["replicates"], said["factors"], said["homes"]) == (2, 2, 2, 5)
    assert said["smallest_effect"] == pytest.approx(0.1)
    assert said["smallest_heterogeneity"] == 0.2 and said["none"]["found"] == 0.03
    assert _campaign(SimpleNamespace(setups=lambda table: None)) == {}


def test_what_is_said_of_a_claim_besides_is_its_own():
    for claim in CLAIMS:
        said = _said({"id": claim.id, "verdict": "supported"})
        assert said["reason"] == claim.reason.format(**claim.limits)
        figures = [f"Figure {each.removeprefix('figure')}" for each in claim.figures]
        assert said["figures"] == " and ".join(figures)
        assert said["verdict"] == "supported"
