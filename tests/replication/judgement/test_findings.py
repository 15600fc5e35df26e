"""What pages say beside the claims, as one counts it by hand."""

from types import SimpleNamespace

import pandas as pd
import pytest

from replication.config.shipped import DESIGN, POWER
from replication.training.measured import ERRORS
from replication.pages.all_results import _on_its_way
from replication.pages.findings import _campaign, _refused


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


def claim(name: str, verdict: str, luck: float) -> dict:
    return {"id": name, "verdict": verdict, "universes": {"luck": luck}}


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
        claims=lambda: [
            claim("schedule", "contradicted", 0.3),
            claim("theta-increments", "supported", 0.5),
            claim("cells-position", "undecided", 0.28),
            claim("rough-search", "undecided", 0.5),
        ],
    )
    said = _campaign(evidence)
    assert (said["setups"], said["replicates"], said["factors"], said["homes"]) == (2, 2, 2, 5)
    assert said["smallest_effect"] == pytest.approx(0.1)
    assert said["found_among"] == {"heterogeneity": 0.3, "share": 0.49}
    assert said["smallest_heterogeneity"] == 0.2 and said["none"]["found"] == 0.03
    assert [its["id"] for its in said["luckier"]] == ["schedule"], "where the power was to tell"
    assert _campaign(SimpleNamespace(setups=lambda table: None)) == {}


@pytest.mark.parametrize(
    ("last", "text"),
    [
        ([2.0, 3.0], "after 1,000 iterations"),  # both are within there, one was before
        ([0.5, 3.0], "in none of its 5,000 iterations"),
    ],
)
def test_ritters_is_said_to_have_both_errors_of_the_improved_one_on_its_way(last, text):
    ours = pd.DataFrame([[9.0, 9.0, 0], [*last, 200]], columns=[*ERRORS, "iteration"])
    # of two seeds: what counts is their mean
    ritters = pd.DataFrame(
        [[9, 9, 0], [1, 4, 100], [3, 4, 100], [1, 2, 1000], [3, 4, 1000], [1, 1, 5000]],
        columns=[*ERRORS, "iteration"],
    )
    histories = {"improved": ours, "ritter_own": ritters}
    roles = {"improved": "improved", "ritter": "ritter_own"}
    assert _on_its_way(SimpleNamespace(history=histories.get, facts=roles)) == text
