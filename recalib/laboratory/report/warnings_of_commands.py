"""Warnings about commands that reach desired poses."""

from typing import Any

import numpy as np

from recalib.laboratory.correction import BASE, Commands, Correction
from recalib.laboratory.report.templates import UNITS, render
from recalib.laboratory.tables.measurements import STILL

FLIP = 180.0  # deg: a joint that turns by more between two rows is on another branch
TURNED = 0.01  # deg: a rotation with a smaller error counts as reached


def warnings_of(correction: Correction, commands: Commands, frame: str | None) -> list[str]:
    """A line for each: what is not identifiable, rotations off, ranges left, flips, far poses."""
    text = render(
        "correct.txt.j2",
        correction=correction,
        commands=commands,
        most=TURNED,
        ends=correction.unidentifiable_ends if frame == BASE else None,
        turned=np.degrees(commands.turned),
        beyond=_beyond(correction, commands) if commands.beyond.any() else None,
        flip=_flip(correction, commands),
    )
    return text.splitlines()


def _beyond(correction: Correction, commands: Commands) -> dict[str, Any]:
    """The number of commands beyond the measured range, and the farthest one [mm, deg]."""
    coupling, postures = correction.arm.coupling, correction.postures
    low, high = postures.min(axis=0), postures.max(axis=0)
    parts = commands.beyond / np.maximum(high - low, STILL)
    row, joint = np.unravel_index(parts.argmax(), parts.shape)
    scale, unit = UNITS[0] if coupling.slides[joint] else UNITS[1]
    return {
        "rows": np.count_nonzero(commands.beyond.any(axis=1)),
        "joints": np.array(coupling.columns)[commands.beyond.any(axis=0)],
        "row": row,
        "joint": joint,
        "unit": unit,
        "far": scale * commands.beyond[row, joint],
        "ends": (scale * low[joint], scale * high[joint]),
    }


def _flip(correction: Correction, commands: Commands) -> dict[str, Any] | None:
    """The largest turn of a joint from a row to the next, if it is a flip."""
    coupling, joints = correction.arm.coupling, commands.joints
    turns = np.degrees(np.abs(np.diff(joints, axis=0, prepend=joints[:1]))) * ~coupling.slides
    row, joint = np.unravel_index(turns.argmax(), turns.shape)
    turn = turns[row, joint]
    return {"row": row, "joint": coupling.columns[joint], "turn": turn} if turn > FLIP else None
