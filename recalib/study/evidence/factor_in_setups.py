"""The factor of 70 over the alternative setups, by the cells of Ritter's net."""

from recalib.study.configuration.switches import RITTER
from recalib.study.evidence.claims import speed_up
from recalib.study.evidence.claims.across import Setups
from recalib.study.evidence.factor import CELLS, in_words
from recalib.study.evidence.needs import DOUBLE
from recalib.study.evidence.results import Evidence
from recalib.study.inference.intervals import Estimate

(SPEED_UP,) = speed_up.CLAIM.across.values()
LEVELS = {DOUBLE: "whole", RITTER: "each"}  # of the choice `cells`
CONTROL = "displacement"  # the choice that reaches no training: named before any outcome


def in_setups(evidence: Evidence) -> dict:
    """The factor over the alternative setups, by cells; empty where they are not measured.

    Beside it stand what it would be if the end of a ladder were a number, and what the choice does
    that reaches no training, the negative control.
    """
    table = evidence.setups(SPEED_UP.table)
    if table is None:
        return {}
    design = evidence.levels()
    cells = table["universe"].map(design["cells"])
    everywhere = SPEED_UP.over(table, design)
    effects = everywhere.effects(evidence.rng("effects", "control")).set_index("factor")
    moved = effects.loc[CONTROL]
    return {
        "rows": [
            {"cells": CELLS[learner]} | _row(SPEED_UP.over(table[cells == level], design))
            for learner, level in LEVELS.items()
        ],
        "at_the_end": SPEED_UP.over(table.assign(bound=0), design).mean,
        "control": Estimate(moved["effect"], moved["low"], moved["high"]),
        "chance": moved["chance"],
    }


def _row(setups: Setups) -> dict:
    return {
        "setups": len(setups.model.numbers),
        "left_out": setups.left_out,
        "factor": setups.mean,
        "verdict": in_words(setups.mean),
        "another": setups.across.back(setups.model.another),
    }
