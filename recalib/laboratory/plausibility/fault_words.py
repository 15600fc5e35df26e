"""Faults in the sequence of rows, in words."""

from collections.abc import Sequence

import numpy as np

from recalib.identification.checks.gains import WrongGain
from recalib.identification.checks.outliers import Displaced, Exchanged
from recalib.identification.checks.sequence import DRIFT, GROWTH, JUMP, LAG, SLIP, Fault
from recalib.identification.model.frames import Frames
from recalib.laboratory.data_set import DataSet
from recalib.laboratory.plausibility.mistakes import SHIFTED
from recalib.spelling import listed

MOST = 6  # rows that are listed


def without_shift(found: Sequence[Fault], mistake: str | None) -> list[Fault]:
    """Faults without the lag if a mistake names it already: rows that are shifted by one."""
    shifted = mistake is not None and mistake.startswith(SHIFTED)
    return [fault for fault in found if not (shifted and fault.kind == LAG)]


def in_words(fault: Fault, data: DataSet, frames: Frames) -> str:
    """What seems to have happened, where, and what to try: a sentence without its full stop."""
    sight, observations = fault.sight, data.observations
    where = f"in {data.tables[sight].parent}, " if len(data.tables) > 1 else ""
    instrument, target = frames.sights[sight]
    stands, moves = data.instruments[instrument], data.target_names[target]
    steady = "a warmed-up instrument"
    if len(frames.sockets):  # there is no instrument
        stands, moves, steady = "the sockets", "the ball", "tighter sockets"
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
        " last, as if warming up; try to warm it up before measuring and before use",
        JUMP: f"{between} {stands.removeprefix('the ')} or base seem to have moved by {moved};"
        f" {parts}",
        SLIP: f"{between} {moves} seems to have slipped on the tool by {moved}; {parts}",
    }
    return where + sentences[fault.kind]


def displaced_in_words(run: Displaced) -> str:
    """Rows that were measured from elsewhere: a sentence without its full stop."""
    off = f"{_short(1e3 * run.shift)} mm and {_short(np.degrees(run.turn))} deg"
    return (
        f"in rows {run.first + 1} to {run.last + 1} instrument or base seem to have stood {off}"
        " from where they stood in all others; try without these rows"
    )


def exchanged_in_words(found: Exchanged) -> str:
    """Rows that hold the measurements of others: a sentence without its full stop."""
    rows, others = (
        listed([str(row + 1) for row in numbers[:MOST]], "and")
        for numbers in (found.rows, found.others)
    )
    of = f"{len(found.rows)} rows, such as " if len(found.rows) > MOST else "rows "
    return f"the measurements of {of}{rows} fit the joints of rows {others}; check their order"


def gain_in_words(wrong: WrongGain, joints: Sequence[str]) -> str:
    """A joint that does not turn as its column says: a sentence without its full stop."""
    joint, by, percent = joints[wrong.joint], joints[wrong.by], 100 * wrong.share
    if joint == by:
        much = f"{_short(abs(percent))} % {'more' if percent > 0 else 'less'}"
        return f"{joint} seems to move {much} than reported; check its gear ratio"
    return (
        f"{joint} seems to turn by {_short(percent)} % of {by} in addition; check whether they are"
        " coupled"
    )


def _short(number: float) -> str:
    """Two digits, and no power of ten where people write none: 100, not 1e+02."""
    return f"{float(f'{number:.2g}'):g}"
