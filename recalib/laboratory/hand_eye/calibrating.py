"""Hand-eye calibration: from a table of flange poses, and pictures or poses of a board."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path

import numpy as np

from recalib.errors import InvalidFile, InvalidSetting
from recalib.identification.hand_eye import calibrate_hand_eye, held_out
from recalib.identification.hand_eye_model import Sights
from recalib.laboratory.hand_eye.mistakes import FEWEST, check_fit, check_motion, check_result
from recalib.laboratory.hand_eye.pose_table import PoseTable, read_poses
from recalib.laboratory.hand_eye.results import HandEyeResult, Shown
from recalib.laboratory.pictures.observe import find_board, pictures_in
from recalib.laboratory.pictures.observed import doubt_of, views_of
from recalib.spelling import counted
from recalib.vision.boards import read_board
from recalib.vision.lenses import read_lens
from recalib.vision.views import optics_of, sighting

FLANGE, TARGETS = DIRECTIONS = "flange", "targets"  # tables whose poses can be inverse


@dataclass(frozen=True)
class Reading:
    """How tables of poses are read.

    Attributes:
        convention, target_convention: see `read_poses`.
        unit: of positions without one.
        inverse: tables whose poses are in the other direction.
        height: m, and its standard deviation; see `Sights`.
    """

    convention: str | None = None
    target_convention: str | None = None
    unit: str | None = None
    inverse: Sequence[str] = ()
    height: tuple[float, float] | None = None

    def flange(self, path: str | PathLike[str]) -> PoseTable:
        """The poses of the flange in the base. Raises InvalidFile, UnknownName."""
        table = read_poses(path, self.convention, self.unit)
        return replace(table, inverted=FLANGE in self.inverse)

    def targets(self, path: str | PathLike[str]) -> PoseTable:
        """The poses of the target in the camera. Raises likewise."""
        table = read_poses(path, self.target_convention, self.unit)
        return replace(table, inverted=TARGETS in self.inverse)


def calibrate_by_pictures(
    poses: str | PathLike[str],
    folder: str | PathLike[str],
    board: str | PathLike[str],
    lens: str | PathLike[str] | None = None,
    in_hand: bool = False,
    reading: Reading | None = None,
    on_progress: Callable[[str], None] = lambda line: None,
) -> HandEyeResult:
    """Where camera and board are, by pictures.

    Args:
        poses: the table of the flange's poses; without a column `picture`, its rows are those of
            the pictures in the order of their names.
        folder, board, lens, in_hand, on_progress: see `recalib.laboratory.pictures.observe`.
        reading: how the table is read (default: by its headings).

    Raises RecalibError: files that cannot be used, poses that do not determine it, and mistakes.
    """
    reading = reading or Reading()
    table, sheet = reading.flange(poses), read_board(board)
    given = None if lens is None else read_lens(lens)
    if (names := table.pictures) is None:
        if not Path(folder).is_dir():
            raise InvalidFile(folder, "there is no such folder of pictures")
        names = [path.name for path in pictures_in(folder)]
        if len(names) != len(table):
            counts = f"it has {counted(len(table), 'row')}, and {folder} has {len(names)} pictures"
            raise InvalidFile(table.path, f"{counts}; try: a column 'picture' with their names")
    found = find_board(folder, names, table.path, sheet, given, on_progress, FEWEST)
    used, known = [one for one in found.pictures if one.corners], given or found.own.lens
    rows = np.array([picture.row - 1 for picture in used])
    views = views_of(sheet, used)
    seen = [sighting(sheet, known, view, given is None, False) for _, view in views]
    measured, optics = optics_of(known, seen)
    flange = table[rows]
    sights = Sights(flange.poses, measured, in_hand, optics, reading.height)
    shown = Shown(sheet, known, given is None, found.pictures, doubt_of(given, found.own, views))
    return _calibrated(sights, (flange, None), shown, on_progress)


def calibrate_by_targets(
    poses: str | PathLike[str],
    targets: str | PathLike[str],
    in_hand: bool = False,
    reading: Reading | None = None,
    on_progress: Callable[[str], None] = lambda line: None,
) -> HandEyeResult:
    """The same by a table of the target's poses in the camera, row by row as those of the flange.

    Raises likewise.
    """
    reading = reading or Reading()
    flange, target = reading.flange(poses), reading.targets(targets)
    if len(flange) != len(target):
        valid = f"expected: {len(flange)}, as in {flange.path.name}"
        raise InvalidFile(target.path, f"it has {counted(len(target), 'row')}; {valid}")
    sights = Sights(flange.poses, target.poses, in_hand, None, reading.height)
    return _calibrated(sights, (flange, target), None, on_progress)


def _calibrated(
    sights: Sights,
    tables: tuple[PoseTable, PoseTable | None],
    shown: Shown | None,
    on_progress: Callable[[str], None],
) -> HandEyeResult:
    check_motion(sights)
    on_progress("camera and board")
    found = calibrate_hand_eye(sights)
    check_fit(found, *tables)
    check_result(found)
    on_progress("errors of poses that are held out")
    return HandEyeResult(found, tables[0].path.name, held_out(found), shown)


def read_height(text: str | None, kind: Callable[[str, str], float]) -> tuple[float, float] | None:
    """A height and its deviation, of '312 mm' or '312 mm +- 2 mm'. Raises InvalidSetting."""
    if text is None:
        return None
    value, _, within = text.partition("+-")
    deviation = kind("--height", within) if within else 1e-4
    if deviation <= 0:
        raise InvalidSetting("--height", text, "a deviation of more than zero")
    return kind("--height", value), deviation
