"""Faults in the sequence of rows, in words."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from recalib.identification.checks.couplings import Coupling
from recalib.identification.checks.sequence import DRIFT, GROWTH, JUMP, LAG, SLIP, Fault
from recalib.identification.model.frames import Frames
from recalib.identification.model.observations import Observations


def in_words(
    fault: Fault,
    observations: Observations,
    frames: Frames,
    tables: Sequence[Path],
    instruments: Sequence[str],
    ends: Sequence[str],
) -> str:
    """What seems to have happened, where, and what to try: a sentence without its full stop.

    Args:
        tables: the files that the observations are from.
        instruments, ends: what the frames are of, by their numbers.
    """
    sight = fault.sight
    where = f"in {tables[sight].parent}, " if len(tables) > 1 else ""
    instrument, target = frames.sights[sight]
    stands, moves, steady = instruments[instrument], ends[target], "an instrument that is warm"
    if len(frames.sockets):  # there is no instrument
        stands, moves, steady = "the sockets", "the ball", "sockets that are fastened"
    series = observations.series
    rows = np.count_nonzero(series == series[observations.targets == sight][0])
    seem = "seem" if len(frames.sockets) else "seems"
    size, late = f"{_short(1e3 * fault.size)} mm", abs(fault.size)
    moved = f"{size} and {_short(np.degrees(fault.turn))} deg"
    between = f"between rows {fault.row} and {fault.row + 1}"
    parts = f"try rows 1 to {fault.row} and {fault.row + 1} to {rows} each by themselves"
    if not fault.row:
        between, parts = "before row 1", "try each folder by itself"
    lag = (
        f"{_short(100 * late)} % of a step"
        if observations.times is None
        else f"{_short(1e3 * late)} ms"
    )
    sentences = {
        LAG: f"poses seem to be {lag} {'behind' if fault.size > 0 else 'ahead of'} the joints; try"
        " to measure at rest, or to synchronise both",
        DRIFT: f"{stands} {seem} to drift by {size} from the first row to the last; try a"
        f" shorter session, or {steady}",
        GROWTH: f"the arm seems to grow by {_short(100 * fault.size)} % from the first row to the"
        " last, as one that warms up; try to move it for a while before, and use it as warm",
        JUMP: f"{between} {stands.removeprefix('the ')} or base seem to have moved by {moved};"
        f" {parts}",
        SLIP: f"{between} {moves} seems to have slipped on the tool by {moved}; {parts}",
    }
    return where + sentences[fault.kind]


def coupling_in_words(coupling: Coupling, joints: Sequence[str]) -> str:
    """Likewise, of joints that do not turn as their columns say."""
    joint, by, percent = joints[coupling.joint], joints[coupling.by], 100 * coupling.share
    if joint == by:
        much = f"{_short(abs(percent))} % {'more' if percent > 0 else 'less'}"
        return f"{joint} seems to move {much} than its column says; try its gear ratio"
    return (
        f"{joint} seems to turn by {_short(percent)} % of {by} in addition to what its column says;"
        " are they coupled?"
    )


def _short(number: float) -> str:
    """Two digits, and no power of ten where people write none: 100, not 1e+02."""
    return f"{float(f'{number:.2g}'):g}"
