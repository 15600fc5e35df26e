"""Calibration of an arm that moves and measures by itself; see docs/live.md."""

from collections.abc import Callable
from dataclasses import dataclass
from os import PathLike

import numpy as np

from recalib.errors import InvalidFile, InvalidSetting, RecalibError
from recalib.identification.checks.diagnostics import FEWEST
from recalib.identification.model.observations import Observations
from recalib.laboratory.live.allowed import AllowedPostures, Box
from recalib.laboratory.live.record import Pictures, Record
from recalib.laboratory.live.running import AHEAD, RunningCalibration
from recalib.laboratory.tables.description import Description
from recalib.nominal.kinematics import Arm
from recalib.station.guarded import REACHED, Guarded
from recalib.station.interface import Station, StationFailed

USELESS = 0.05  # a part of the predicted error: what gains less is not worth ten moves
NARROWEST = 2 * REACHED  # rad: postures that are nearer count as one
LONGEST = 86_400.0  # s that a move or a measurement may take
UNSEEN = 10  # postures in a row without a sight of the target: it is lost, or they are too far


@dataclass(frozen=True)
class LiveSettings:
    """How to calibrate.

    Attributes:
        error: m that the predicted mean error should have; None to go on while it is of use.
        most: rows in the table, at which it ends.
        span: rad that each joint may move either way from where it stood at first; half a metre for
            each rad where it slides.
        box: in which the nominal tool link stays; None where the limits of the joints are enough.
        speed: of the fastest joint, as a part of what it allows.
        patience: s that the station may take for an answer.

    Raises InvalidSetting: no calibration goes by these.
    """

    error: float | None = None
    most: int = 60
    span: float = np.radians(45)
    box: Box | None = None
    speed: float = 0.1
    patience: float = 60.0

    def __post_init__(self) -> None:
        if self.error is not None and not 0 < self.error < np.inf:
            raise InvalidSetting("error", f"{1e3 * self.error:g} mm", "more than zero")
        if self.most < FEWEST:
            valid = f"at least {FEWEST} rows, which a calibration needs"
            raise InvalidSetting("most", self.most, valid)
        if not NARROWEST < self.span < np.inf:
            valid = f"more than {np.degrees(NARROWEST):.2g} deg: nearer postures count as one"
            raise InvalidSetting("span", f"{np.degrees(self.span):g} deg", valid)
        if not 0 < self.speed <= 1:
            raise InvalidSetting("speed", self.speed, "above 0 and up to 1")
        if not 0 < self.patience <= LONGEST:
            raise InvalidSetting("patience", f"{self.patience:g} s", "above 0 s, up to a day")


class Interrupted(RecalibError):
    """A person has stopped it."""


def calibrate_live(
    opening: Callable[[], Station],
    arm: Arm,
    table: str | PathLike[str],
    settings: LiveSettings,
    ask: Callable[[np.ndarray], bool],
    description: Description | None = None,
    on_progress: Callable[[str], None] = lambda line: None,
    on_row: Callable[[Observations, RunningCalibration], None] = lambda rows, running: None,
    pictures: Pictures | None = None,
) -> str:
    """Move, measure and add rows to a table until it is enough, and say why it is.

    It begins where the arm stands, or goes on with the rows that are there. Whatever goes wrong,
    the station is stopped and nothing moves any more.

    Args:
        opening: makes the station.
        arm: the nominal one.
        table: CSV, new or begun by this function.
        ask: called with the joint angles (joints,) [rad, m] to move to next; whether it may.
        description: what the table does not say itself.
        on_progress: called with a line for each row.
        on_row: called with the rows so far, and what calibrates by them.
        pictures: what those of the column `picture` say, if the rows go by their pixels.

    Raises RecalibError: StationFailed, Interrupted, or rows that do not fit the arm.
    """
    description = description or Description()
    record = Record(table, arm, description, pictures)
    if record.dropped:
        on_progress(f"a row without its end was dropped: {record.dropped!r}")
    station = None
    try:
        station = Guarded(opening, arm.joints, settings.patience)
        return _go_on(station, arm, record, settings, ask, description, on_progress, on_row)
    except BaseException as error:
        if station is not None:
            station.stop()
        if len(record):
            on_progress(f"stopped; {len(record)} rows are in {record.path}: the same call goes on")
        if isinstance(error, KeyboardInterrupt):
            told = "was not open yet" if station is None else "was told to stop"
            raise Interrupted(f"interrupted; the station {told}") from None
        raise
    finally:
        if station is not None:
            station.close()
        record.close()


def _go_on(
    station: Guarded,
    arm: Arm,
    record: Record,
    settings: LiveSettings,
    ask: Callable[[np.ndarray], bool],
    description: Description,
    on_progress: Callable[[str], None],
    on_row: Callable[[Observations, RunningCalibration], None],
) -> str:
    started = record.observations
    home = station.angles() if started is None else started.joints[0]
    postures = AllowedPostures(arm, home, station.limits(), settings.span, settings.box)
    running = RunningCalibration(arm, description, postures, record.pictures)
    rows = started or _measured(station, record, running)
    if rows is None:
        raise StationFailed(
            "the instrument does not see the target where the arm stands; try: begin where it does"
        )
    unseen: list[np.ndarray] = []
    lost = 0
    while True:
        reason = _enough(rows, running, unseen, settings, on_progress)
        on_row(rows, running)
        if reason is not None:
            return reason
        goal = running.next_posture(rows, unseen)
        if goal is None:
            return "each allowed posture was measured"
        path = postures.path(station.angles(), goal)
        if path is None:
            raise StationFailed(
                "no straight path in joint space leads from where the arm stands to the next"
                " posture or to the first within the box; try: move it back by hand"
            )
        for posture in path:
            if not ask(posture):
                return "you ended it"
            station.move(posture, settings.speed)
        measured = _measured(station, record, running)
        rows, lost = measured or rows, 0 if measured else lost + 1
        if measured is None:
            unseen.append(goal)
            on_progress("the instrument does not see the target there")
        if lost == UNSEEN:
            raise StationFailed(
                f"the instrument has not seen the target in {UNSEEN} postures, one after the other;"
                " if it is still there, try: a smaller --span"
            )


def _measured(station: Guarded, record: Record, running: RunningCalibration) -> Observations | None:
    """All rows with one more, which is on the disk; None where the target is not seen."""
    angles, cells = station.measure()
    if cells is None:
        return None
    try:
        rows, line = record.read(angles, cells)
    except InvalidFile as error:
        raise StationFailed(f"what the station measured is no row: {error.reason}") from None
    if (wrong := running.check(rows)) is not None:
        raise StationFailed(wrong)
    record.write(rows, line)
    return rows


def _enough(
    rows: Observations,
    running: RunningCalibration,
    unseen: list[np.ndarray],
    settings: LiveSettings,
    on_progress: Callable[[str], None],
) -> str | None:
    """Why the rows are enough; None where they are not."""
    count = len(rows)
    if not running.is_ready(rows):
        on_progress(f"row {count}")
        return f"it has {count} rows, as many as allowed" if count >= settings.most else None
    error = running.error(rows)
    by_rows = f"{1e3 * error.by_rows:.3g} mm" if np.isfinite(error.by_rows) else "too few rows"
    on_progress(
        f"row {count}: predicted error by the model {1e3 * error.by_model:.3g} mm, by the last rows"
        f" {by_rows}"
    )
    known = np.isfinite(error.total)
    total = f"the predicted error is {f'{1e3 * error.total:.3g} mm' if known else 'not known yet'}"
    # the last of few pictures say nothing of postures that the camera does not see
    trusted = rows.optics is None or running.is_settled(rows)
    if settings.error is not None and error.total <= settings.error and trusted:
        return f"{total}; {1e3 * settings.error:g} mm was asked for"
    if running.is_settled(rows) and running.gain(rows, unseen) < USELESS:
        return f"{total}, and {AHEAD} further postures would hardly make it smaller"
    return f"{total}; {count} rows are as many as allowed" if count >= settings.most else None
