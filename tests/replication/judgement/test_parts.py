"""What the verdicts would be on parts of the setups, where the effect depends on a known choice."""

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from replication.judgement.claims import changes
from replication.pages.parts import otherwise, parts
from tests.replication.judgement.test_across import LEVELS, SETUPS, outcomes

COLUMN = next(iter(changes.JACOBIAN.across.values())).column


def evidence(by_effort, verdict="undecided", reference=(0.8, 0.7, 0.9), **strongest):
    """A claim whose ratio is another one by the effort of the search."""
    design = LEVELS.assign(effort=np.where(LEVELS["effort"] == "0", "full", "rough"))
    table = outcomes(COLUMN, 0.0, luck=0.02, own=0.02)
    table[COLUMN] *= table["universe"].map(design["effort"]).map(by_effort)
    moves = {"factor": "home", "effect": 1.0, "chance": 1.2} | strongest
    judged = {
        "id": changes.JACOBIAN.id,
        "verdict": verdict,
        "measured": {"improved system": reference[0]},
        "interval": {"improved system": list(reference[1:])},
        "universes": {"status": "measured", "depends_on": moves},
    }
    return SimpleNamespace(
        claims=lambda: [judged], setups=lambda _: table, levels=lambda: pd.DataFrame(design)
    )


def test_the_part_in_which_a_change_helps_is_told():
    full, rough = rows = parts(evidence({"full": 0.8, "rough": 1.3}))
    assert (full["level"], full["setups"], full["verdict"]) == ("full", SETUPS / 2, "supported")
    assert full["mean"].mean == pytest.approx(0.8, rel=0.02)
    assert rough["mean"].mean == pytest.approx(1.3, rel=0.02)
    assert otherwise(rows) == 1


def test_a_reference_study_on_the_other_side_leaves_a_part_undecided():
    _, rough = parts(evidence({"full": 0.8, "rough": 1.3}))
    assert rough["verdict"] == "undecided"  # the reference study says supported


def test_parts_that_agree_with_the_whole_are_not_told():
    assert parts(evidence({"full": 0.8, "rough": 0.8}, "supported")) == []
    assert otherwise([]) == 0


@pytest.mark.parametrize(("effect", "told"), [(1.3, {"effort", "robot"}), (1.1, {"effort"})])
def test_besides_the_effort_the_choice_beyond_chance_is_looked_at(effect, told):
    mixed = evidence({"full": 0.8, "rough": 1.3}, "contradicted", factor="robot", effect=effect)
    assert {row["factor"] for row in parts(mixed)} == told
