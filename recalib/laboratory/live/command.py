"""`recalib live`: its options become a calibration that moves the arm; see docs/live.md."""

import argparse
import math
import signal
import sys
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

from recalib.errors import InvalidSetting
from recalib.files.quantities import ANGLE, LENGTH, TIME
from recalib.files.storage import read_file
from recalib.laboratory.live.allowed import Box
from recalib.laboratory.live.calibration import LiveSettings, calibrate_live
from recalib.laboratory.live.record import Pictures
from recalib.laboratory.tables.description import read_description
from recalib.nominal.arms import load_arm
from recalib.nominal.descriptions import MOST, find_urdf
from recalib.station.interface import Station
from recalib.station.opening import open_station


def measure_live(given: argparse.Namespace, on_progress: Callable[[str], None]) -> str:
    """Move, measure and write rows as the options say; the reason why they are enough.

    Raises RecalibError, as `calibrate_live` and as what reads the options.
    """
    arm, settings = load_arm(given.urdf, given.tool, given.base), _settings(given)
    if given.board is None and (given.lens or given.camera):
        raise InvalidSetting("--board", None, "a board, which --lens and --camera are for")
    for number in (signal.SIGTERM, signal.SIGHUP):  # who closes the terminal means a stop, too
        signal.signal(number, signal.default_int_handler)
    opening: Callable[[], Station] = partial(open_station, given.station)
    pictures: Pictures | None = None
    if given.board is not None:
        opening, pictures = _with_board(opening, given)
    ask = partial(_ask_to_move, arm.joints, arm.slides.tolist())
    watch: dict[str, Any] = {}
    if given.view:
        from recalib.laboratory.live.view import LiveView

        urdf = find_urdf(given.urdf)
        watch["on_row"] = LiveView(arm, read_file(urdf, MOST), urdf).show
    return calibrate_live(
        opening,
        arm,
        given.table,
        settings,
        (lambda posture: True) if given.yes else ask,
        given.description and read_description(given.description),
        on_progress,
        pictures=pictures,
        **watch,
    )


def _settings(given: argparse.Namespace) -> LiveSettings:
    error = None if given.error is None else LENGTH.value_of("--error", given.error)
    box = None if given.box is None else Box.read(given.box)
    span = ANGLE.value_of("--span", given.span)
    patience = TIME.value_of("--patience", given.patience)
    try:
        return LiveSettings(error, given.most, span, box, given.speed, patience)
    except InvalidSetting as wrong:
        raise InvalidSetting(f"--{wrong.key}", wrong.value, wrong.valid) from None


def _with_board(
    opening: Callable[[], Station], given: argparse.Namespace
) -> tuple[Callable[[], Station], Pictures]:
    """What opens a station that takes pictures as one that measures, and what is in them."""
    from recalib.laboratory.pictures.observe import IN_HAND
    from recalib.station.pictures import BoardInPictures, PicturesOfABoard
    from recalib.vision.boards import read_board
    from recalib.vision.lenses import read_lens

    if given.lens is None:
        raise InvalidSetting("--lens", None, "the calibration of the lens, which --board needs")
    board, lens = read_board(given.board), read_lens(given.lens)
    pictures = BoardInPictures(board, lens, given.camera == IN_HAND)
    return lambda: PicturesOfABoard(opening(), pictures), pictures


def _ask_to_move(joints: Sequence[str], slides: Sequence[bool], posture: Sequence[float]) -> bool:
    """Whether a person lets the arm move to a posture (joints,) [rad, m]."""
    goals = (
        f"{joint} {1e3 * goal:.1f} mm" if slide else f"{joint} {math.degrees(goal):.1f} deg"
        for joint, slide, goal in zip(joints, slides, posture, strict=True)
    )
    print(f"Move to {', '.join(goals)}? Enter: yes; anything else: end ", file=sys.stderr, end="")
    sys.stderr.flush()
    answer = sys.stdin.readline()
    if not answer:
        raise InvalidSetting("an answer", None, "a person at the terminal, or --yes")
    return not answer.strip()
