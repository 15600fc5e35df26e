"""The factor of 70 over the alternative setups, by the cells of Ritter's net."""

from typing import TYPE_CHECKING

from recalib.study.configuration.switches import RITTER
from recalib.study.evidence.claims import speed_up
from recalib.study.evidence.factor import CELLS, in_words
from recalib.study.evidence.needs import DOUBLE
from recalib.study.evidence.results import Evidence
from recalib.study.inference.intervals import UNKNOWN, Estimate

if TYPE_CHECKING:
    import pandas as pd

(SPEED_UP,) = speed_up.CLAIM.across.values()
LEVELS = {DOUBLE: "whole", RITTER: "each"}  # of the choice `cells`
CONTROL = "displacement"  # the choice that reaches no training: named before any outcome


def in_setups(evidence: Evidence) -> dict:
    """The factor over the alternative setups, by cells; empty where no mean is known.

    Beside it stand what it would be if the end of a ladder were a number, and what the choice does
    that reaches no training, the negative control.
    """
    table = evidence.setups(SPEED_UP.table)
    if table is None:
        return {}
    design = evidence.levels()
    cells = table["universe"].map(design["cells"])
    everywhere = SPEED_UP.over(table, design)
    at_the_end = SPEED_UP.over(table.assign(bound=0), design)
    if everywhere is None or at_the_end is None:
        return {}
    effects = everywhere.effects(evidence.rng("effects", "control")).set_index("factor")
    moved = effects.loc[CONTROL]
    return {
        "rows": [
            {"cells": CELLS[learner]} | _row(table[cells == level], design)
            for learner, level in LEVELS.items()
        ],
        "at_the_end": at_the_end.mean,
        "control": Estimate(moved["effect"], moved["low"], moved["high"]),
        "chance": moved["chance"],
    }


def _row(table: "pd.DataFrame", design: "pd.DataFrame") -> dict:
    setups = SPEED_UP.over(table, design)
    if setups is None:
        unknown = {"factor": UNKNOWN, "verdict": in_words(UNKNOWN), "another": UNKNOWN}
        return {"setups": 0, "left_out": table["universe"].nunique()} | unknown
    return {
        "setups": len(setups.model.numbers),
        "left_out": setups.left_out,
        "factor": setups.mean,
        "verdict": in_words(setups.mean),
        "another": setups.across.back(setups.model.another),
    }
