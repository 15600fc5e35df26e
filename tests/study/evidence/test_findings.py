"""What the page of findings says; that it is written as the claims have it, other tests show."""

from types import SimpleNamespace

import pandas as pd
import pytest

from recalib.study.configuration.shipped import DESIGN, POWER
from recalib.study.evidence.claims import CLAIMS
from recalib.study.evidence.findings import (
    NEEDS,
    _campaign,
    _ensemble,
    _refused,
    _said,
    _scaled,
    context,
)
from recalib.study.inference.measured import ERRORS


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


def finals(cm, deg, **others) -> pd.DataFrame:
    columns = dict(zip([f"final_{error}" for error in ERRORS], (cm, deg), strict=True))
    return pd.DataFrame({"robot": range(len(cm)), **columns, **others})


def test_other_damages_are_medians_and_ritters_are_beside_ours_on_the_same_robots():
    ours = finals([1.0, 2, 3, 4, 100], [5.0, 4, 3, 2, 1])
    ritters = finals([10.0, 20, 90], [30.0, 50, 40])
    assert _ensemble(ours, ritters) == pytest.approx(
        {
            "robots": 5,
            "ritter_robots": 3,
            "median_cm": 3,
            "p95_cm": 80.8,
            "ritter_cm": 20,
            "same_cm": 2,
            "median_deg": 3,
            "p95_deg": 4.8,
            "ritter_deg": 40,
            "same_deg": 4,
        }
    )


def test_of_scaled_damages_the_larger_part_that_is_left_counts():
    initial = {f"initial_{ERRORS[0]}": 10.0, f"initial_{ERRORS[1]}": 4.0}
    scales = {"scale": [3.0, 0.5] * 3}
    table = finals([1.0, 5, 2, 6, 9, 7], [2.0, 1, 3, 1, 4, 1], **initial, **scales)
    small, large = _scaled(table)
    assert small == {
        "scale": 0.5,
        "initial_cm": 10,
        "initial_deg": 4,
        "final_cm": 6,
        "final_deg": 1,
        "left": 0.6,
    }
    assert (large["final_cm"], large["final_deg"], large["left"]) == (2, 3, 0.75)


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


def test_the_rest_is_counted_in_the_results(made_up):
    """A hundred trials of each search were made up."""
    said = context(made_up.evidence(NEEDS))
    assert (said["trials"], said["searches"]) == (100, 4)
    assert (said["iterations"], said["ritter_iterations"]) == (200, 10_000)
    assert said["scaled_robots"] == said["ensemble"]["robots"] == 12
    assert len(said["factors"]) == 12
    assert said["figures"] == [f"figure{number}" for number in (4, 5, 6, 7, 8, 9, 10)]
