"""A session of moves and measurements that calibrates an arm; see docs/live.md."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from numbers import Integral, Real
from typing import NamedTuple

import numpy as np
import pinocchio as pin

from recalib.errors import InvalidFile, InvalidSetting, RecalibError, UnsuitableRobot, check_kind
from recalib.files.outputs import AnyPath
from recalib.identification.checks.diagnostics import FEWEST
from recalib.identification.model.observations import Observations
from recalib.laboratory.live.allowed import AllowedPostures, Box
from recalib.laboratory.live.clearance import Clearance
from recalib.laboratory.live.record import Record
from recalib.laboratory.live.running import AHEAD, RunningCalibration
from recalib.laboratory.tables.description import Description
from recalib.nominal.kinematics import Arm
from recalib.station.guarded import REACHED, Guarded, StationRaised
from recalib.station.interface import Pictures, Station, StationFailed

USELESS = 0.05  # of the predicted error: a smaller reduction is not worth ten moves
SOON = 20  # rows before this is judged: errors beyond geometry do not show in fewer
NARROWEST = 2 * REACHED  # rad: nearer postures count as one
KINDS = {"error": Real, "floor": Real, "most": Integral, "span": Real, "speed": Real}  # of settings
OPTIONAL = "error", "floor"
TRIES = 3  # attempts to measure in a posture
LOST = 10  # successive postures without sight of the target: it is lost, or they are too far


@dataclass(frozen=True)
class LiveSettings:
    """Settings of a live calibration.

    Attributes:
        error: m, predicted mean error at which to end; None to go on while more rows help.
        most: rows in the table at which to end.
        span: rad, the largest distance of each joint from the first posture; for a sliding joint,
            half a metre for each rad.
        box: that the nominal tool link must not leave; None if joint limits are enough.
        speed: of the fastest joint, as a fraction of its limit.
        floor: m, the height of the floor in the arm's base; None without a floor.
        self_collision: whether to check that links keep apart.

    Raises InvalidSetting: a value out of range.
    """

    error: float | None = None
    most: int = 60
    span: float = np.radians(45)
    box: Box | None = None
    speed: float = 0.1
    floor: float | None = 0.0
    self_collision: bool = True

    def __post_init__(self) -> None:
        check_kind("box", self.box, Box, type(None))
        for name, kind in KINDS.items():
            given = getattr(self, name)
            if not isinstance(given, kind) and (given is not None or name not in OPTIONAL):
                raise InvalidSetting(name, given, "a number")
        if self.floor is not None and not np.isfinite(self.floor):
            raise InvalidSetting("floor", self.floor, "a height in m, or None")
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


class Interrupted(RecalibError):
    """A person interrupted the calibration."""


class Answer(Enum):
    """A person's answer to a proposed move of the arm."""

    MOVE, SKIP, END = "move", "skip the posture for good", "end"


class Move(NamedTuple):
    """A proposed move from start to goal."""

    start: np.ndarray  # (joints,) rad, m
    goal: np.ndarray  # (joints,) rad, m
    tool_before: np.ndarray  # (3,) m, position of the nominal tool in the arm's base at the start
    tool_after: np.ndarray  # (3,) m, at the goal


class Ended(NamedTuple):
    """The reason why a session ended, and the number of rows in its table."""

    reason: str
    rows: int


def calibrate_live(
    opening: Callable[[], Station],
    arm: Arm,
    table: AnyPath,
    settings: LiveSettings,
    ask: Callable[[Move], Answer] = lambda move: Answer.MOVE,
    description: Description | None = None,
    on_progress: Callable[[str], None] = lambda line: None,
    on_row: Callable[[Observations, RunningCalibration], None] = lambda rows, running: None,
    pictures: Pictures | None = None,
    shapes: pin.GeometryModel | None = None,
) -> Ended:
    """Let an arm move and measure until its calibration is accurate enough.

    It begins at the arm's present posture, or continues with the rows of the table. If anything
    goes wrong, it stops the station and commands no further move.

    Args:
        opening: opens the station.
        arm: the nominal arm.
        table: CSV, new or begun by this function.
        ask: called before each move, returns whether to make it; default: all are made.
        description: frames, distances and columns that the table cannot express.
        on_progress: called with lines of text.
        on_row: called with the rows so far, and the running calibration.
        pictures: reads the pictures in the column `picture`, if rows are measured by a camera.
        shapes: of the links, see `load_shapes`; without them, only the tool must clear the floor.

    Raises RecalibError: UnsuitableRobot, StationFailed, Interrupted, InvalidSetting (something else
    than an arm, settings or an answer), or rows that do not fit.
    """
    check_kind("arm", arm, Arm)
    check_kind("settings", settings, LiveSettings)
    if not callable(opening):
        raise InvalidSetting("opening", type(opening).__name__, "a function that makes a station")
    if len(arm.coupling.columns) < len(arm.joints):
        followers = f"some of {', '.join(arm.joints)} follow other joints by <mimic>"
        raise UnsuitableRobot(
            f"{followers}; expected: a motor for each joint; try: a table for recalib calibrate"
        )
    description = description or Description()
    record = Record(table, arm, description, pictures)
    if record.dropped:
        on_progress(f"an incomplete row was dropped: {record.dropped!r}")
    station = None
    try:
        station = Guarded(opening, arm)
        started = record.observations
        home = station.angles() if started is None else started.joints[0]
        radius = 0.0 if pictures is None else pictures.tool_radius
        checks = settings.floor, settings.self_collision, radius
        clearance = Clearance(arm, home, shapes or pin.GeometryModel(), *checks)
        postures = AllowedPostures(
            arm, home, station.limits(), settings.span, settings.box, clearance
        )
        places = 1e3 * np.array([postures.tool(joints) for joints in postures.joints])
        ends = zip("xyz", places.min(axis=0), places.max(axis=0), strict=True)
        ranges = ", ".join(f"{axis} from {low:.0f} to {high:.0f} mm" for axis, low, high in ends)
        on_progress(f"the tool's range in all candidate postures, in the arm's base: {ranges}")
        if not (shapes and shapes.ngeoms) and (settings.floor is not None or checks[1]):
            on_progress(
                "the URDF has no readable link shapes: floor and self-collision are not checked for"
                " links"
            )
        running = RunningCalibration(arm, description, postures, pictures)
        going = station, record, settings, postures, running, on_progress
        session = _Session(*going, [*record.skipped])
        return Ended(session.run(ask, on_row), len(record))
    except BaseException as error:
        if station is not None:
            try:
                station.stop()
            except KeyboardInterrupt:  # a terminal that closes fails first, then sends a signal
                station.stop()
        if len(record):
            on_progress(
                f"stopped; {len(record)} rows are in {record.path}; to continue, repeat the command"
            )
        if isinstance(error, KeyboardInterrupt):
            which = "was not open yet" if station is None else "was told to stop"
            raise Interrupted(f"interrupted; the station {which}") from None
        raise
    finally:
        if station is not None:
            station.close()
        record.close()


@dataclass(frozen=True)
class _Session:
    """A running session: the station, the rows so far, and the postures to choose from."""

    station: Guarded
    record: Record
    settings: LiveSettings
    postures: AllowedPostures
    running: RunningCalibration
    on_progress: Callable[[str], None]
    avoided: list[np.ndarray]  # postures without sight of the target, or skipped; it grows

    def run(
        self,
        ask: Callable[[Move], Answer],
        on_row: Callable[[Observations, RunningCalibration], None],
    ) -> str:
        """Measure until the rows are enough, and return the reason."""
        rows, unseen = self.record.observations or self._measured(), 0
        if rows is None:
            raise StationFailed(
                "the target is out of sight in the first posture; try: start where the instrument"
                " sees it"
            )
        while True:
            reason = self._enough(rows)
            on_row(rows, self.running)
            if reason is not None:
                return reason
            goal = self.running.next_posture(rows, self.avoided)
            if goal is None:
                return "each allowed posture was measured"
            answer = self._go_to(goal, ask)
            if answer is Answer.SKIP:
                self.record.skip(goal)
                self.avoided.append(goal)
                continue
            if answer is not Answer.MOVE:
                return "you ended it"
            measured = self._measured()
            rows, unseen = measured or rows, 0 if measured else unseen + 1
            if measured is None:
                self.avoided.append(goal)
                self.on_progress("the target is out of sight there")
            if unseen == LOST:
                raise StationFailed(
                    f"the target was out of sight in {LOST} postures in a row; if it is still in"
                    " place, try: a smaller --span"
                )

    def _go_to(self, goal: np.ndarray, ask: Callable[[Move], Answer]) -> Answer:
        """Move to a posture if a person agrees, and return the answer."""
        for posture in self.postures.path(self.station.angles(), goal):
            start, tool = self.station.angles(), self.postures.tool
            self.postures.check(start, posture)
            answer = ask(Move(start, posture, tool(start), tool(posture)))
            check_kind("the answer to a move", answer, Answer)
            if answer is not Answer.MOVE:
                return answer
            # a person may have moved the arm while the question was open
            self.postures.check(self.station.angles(), posture)
            self.station.move(posture, self.settings.speed)
        return Answer.MOVE

    def _measured(self) -> Observations | None:
        """All rows with a new one, which is on the disk; None if the target is hidden."""
        for left in reversed(range(TRIES)):
            try:
                angles, cells = self.station.measure()
            except StationRaised:
                if not left:
                    raise
                continue
            if cells is not None:
                break
        else:
            return None
        try:
            rows, line = self.record.read(angles, cells)
        except InvalidFile as error:
            raise StationFailed(f"the station's measurement is invalid: {error.reason}") from None
        if (wrong := self.running.check(rows)) is not None:
            raise StationFailed(wrong)
        self.record.write(rows, line)
        return rows

    def _enough(self, rows: Observations) -> str | None:
        """The reason why the rows are enough; None if they are not."""
        count, settings = len(rows), self.settings
        most = f"the limit of {count} rows is reached" if count >= settings.most else None
        if not self.running.is_ready(rows):
            self.on_progress(f"row {count}")
            return most
        error = self.running.error(rows)
        if not np.isfinite(error):
            self.on_progress(f"row {count}: too few for a predicted error")
            return most
        total = f"the predicted error is {1e3 * error:.3g} mm"
        self.on_progress(f"row {count}: {total}")
        # few pictures do not show the errors in postures that the camera has not seen
        trusted = rows.optics is None or count >= SOON
        if settings.error is not None and error <= settings.error and trusted:
            return f"{total}; {1e3 * settings.error:g} mm was requested"
        if count >= SOON and self.running.gain(rows, self.avoided) < USELESS:
            return f"{total}; {AHEAD} more rows would reduce it by less than {100 * USELESS:g} %"
        return most and f"{total}; {most}"
