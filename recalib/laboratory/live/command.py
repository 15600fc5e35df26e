"""The command `recalib live`, which moves the arm according to its options; see docs/live.md."""

import argparse
import signal
import sys
import termios
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial

import numpy as np

from recalib import station, vision
from recalib.errors import InvalidSetting
from recalib.files.quantities import ANGLE, LENGTH
from recalib.laboratory.live.allowed import Box
from recalib.laboratory.live.session import Answer, Ended, LiveSettings, Move, calibrate_live
from recalib.laboratory.options import IN_HAND
from recalib.laboratory.tables.description import read_description
from recalib.nominal.arms import load_arm
from recalib.nominal.kinematics import Arm
from recalib.nominal.shapes import load_shapes
from recalib.station.interface import Pictures, Station
from recalib.station.opening import open_station

# A closed terminal, a kill, and a suspension to the background must stop the arm, too.
STOPPING = signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT, signal.SIGTSTP
TOGETHER = 1.0  # s: signals that come so soon after one another count as one
ANSWERS = {"": Answer.MOVE, "s": Answer.SKIP}  # any other, such as q, ends the session
TURNED = 0.05  # deg, mm: a joint that moves less is not listed


def measure_live(given: argparse.Namespace, on_progress: Callable[[str], None]) -> Ended:
    """Move, measure and write rows according to the options. Raises like `calibrate_live`."""
    arm = load_arm(given.urdf, given.tool, given.base)
    error = None if given.error is None else LENGTH.value_of("--error", given.error)
    box = None if given.box is None else Box.read(given.box)
    floor = None if given.floor == "none" else LENGTH.value_of("--floor", given.floor)
    span, apart = ANGLE.value_of("--span", given.span), not given.no_self_collision
    try:
        settings = LiveSettings(error, given.most, span, box, given.speed, floor, apart)
    except InvalidSetting as wrong:
        raise InvalidSetting(f"--{wrong.key}", wrong.value, wrong.valid) from None
    if given.board is None and (given.lens or given.camera):
        raise InvalidSetting("--board", None, "a board for --lens and --camera")
    if given.board is not None and given.lens is None:
        raise InvalidSetting("--lens", None, "the calibration of the lens, which --board needs")
    opening: Callable[[], Station] = partial(open_station, given.station)
    pictures: Pictures | None = None
    if given.board is not None:
        opening, pictures = _with_board(opening, given)
    checked = settings.self_collision or settings.floor is not None
    shapes, missing = load_shapes(arm, given.urdf) if checked else (None, [])
    if missing:
        names = ", ".join(missing)
        on_progress(f"links without a shape, not checked for floor and self-collision: {names}")
    ask = (lambda move: Answer.MOVE) if given.yes else partial(ask_to_move, arm)
    with _signals_that_stop():
        return calibrate_live(
            opening,
            arm,
            given.table,
            settings,
            ask,
            given.description and read_description(given.description),
            on_progress,
            pictures=pictures,
            shapes=shapes,
        )


@contextmanager
def _signals_that_stop() -> Iterator[None]:
    """Let signals that end or suspend the program raise KeyboardInterrupt: it stops the station.

    Signals within a second count as one, so that they do not interrupt the stop. Later ones count
    again, because Python loses an interrupt that is raised while it collects garbage.
    """
    last = -TOGETHER

    def interrupt(*_: object) -> None:
        nonlocal last
        if time.monotonic() - last > TOGETHER:
            last = time.monotonic()
            raise KeyboardInterrupt

    before = {number: signal.signal(number, interrupt) for number in STOPPING}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _with_board(
    opening: Callable[[], Station], given: argparse.Namespace
) -> tuple[Callable[[], Station], Pictures]:
    """A function that opens a station with a camera as one that measures poses, and its board."""
    board, lens = vision.read_board(given.board), vision.read_lens(given.lens)
    pictures = station.BoardInPictures(board, lens, given.camera == IN_HAND)
    return lambda: station.PicturesOfABoard(opening(), pictures), pictures


def ask_to_move(arm: Arm, move: Move) -> Answer:
    """The answer of a person at the terminal to a proposed move.

    Keys that were pressed before the question appeared are not an answer, and are discarded.
    """
    turns = np.where(arm.slides, 1e3, 180 / np.pi) * (move.goal - move.start)
    units = np.where(arm.slides, "mm", "deg")
    joints = ", ".join(
        f"{joint} by {turn:+.1f} {unit}"
        for joint, turn, unit in zip(arm.joints, turns, units, strict=True)
        if abs(turn) > TURNED
    )
    start, goal = (
        ", ".join(f"{1e3 * x:.0f}" for x in place) for place in (move.tool_before, move.tool_after)
    )
    away = 1e3 * np.linalg.norm(move.tool_after - move.tool_before)
    print(f"tool from ({start}) to ({goal}) mm, {away:.0f} mm away: {joints}", file=sys.stderr)
    question = "Move? Enter: yes, s: skip this posture for good, q: end "
    print(question, end="", file=sys.stderr, flush=True)
    if sys.stdin and sys.stdin.isatty():
        termios.tcflush(sys.stdin, termios.TCIFLUSH)
    if not sys.stdin or not (line := sys.stdin.readline()):  # it is None if it was closed
        raise InvalidSetting("an answer", None, "a person at the terminal, or --yes")
    return ANSWERS.get(line.strip().lower(), Answer.END)
