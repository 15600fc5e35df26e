"""Hand-eye calibration: from a table of flange poses, and pictures or poses of a board."""

from collections.abc import Callable
from dataclasses import replace
from os import PathLike
from pathlib import Path

import numpy as np

from recalib.errors import InvalidFile
from recalib.identification.hand_eye import Sights, calibrate_hand_eye, held_out
from recalib.laboratory.hand_eye.mistakes import FEWEST, check_fit, check_motion
from recalib.laboratory.hand_eye.pose_table import PoseTable
from recalib.laboratory.hand_eye.results import HandEyeResult
from recalib.laboratory.pictures.observe import observe, pictures_in
from recalib.laboratory.pictures.observed import PICTURE, Observed, views_of
from recalib.spelling import counted
from recalib.vision.views import optics_of, sighting

Progress = Callable[[str], None]  # called with what is being done, in a line each


def pictures_at(
    flange: PoseTable,
    folder: str | PathLike[str],
    board: str | PathLike[str],
    lens: str | PathLike[str] | None = None,
    in_hand: bool = False,
    on_progress: Progress = lambda line: None,
) -> Observed:
    """What pictures show, taken at poses of a flange; see `observe`, also for what it raises.

    If the table has no column `picture`, its rows are in the order of the pictures' names.
    """
    table = flange.table
    if PICTURE not in table:
        names = [path.name for path in pictures_in(folder)] if Path(folder).is_dir() else []
        if len(names) != len(flange):
            counts = f"it has {counted(len(flange), 'row')}, and {folder} has {len(names)} pictures"
            raise InvalidFile(table.path, f"{counts}; try: a column 'picture' with their names")
        table = replace(table, cells={PICTURE: names}, units={PICTURE: ""})
    return observe(folder, table, board, lens, in_hand, on_progress, least=FEWEST)


def calibrate_poses(
    flange: PoseTable,
    shown: Observed | PoseTable,
    in_hand: bool = False,
    height: tuple[float, float] | None = None,
    on_progress: Progress = lambda line: None,
) -> HandEyeResult:
    """Where camera and board are.

    Args:
        flange: its poses in the base.
        shown: of the board, by pictures, or its poses in the camera, row by row.
        in_hand: whether the camera is on the hand.
        height: m, and its standard deviation; see `Sights`.

    Raises RecalibError: poses that do not determine it, or are likely mistaken.
    """
    pictures = targets = None
    if isinstance(shown, PoseTable):
        targets, board, optics = shown, shown.poses, None
        if len(flange) != len(targets):
            valid = f"expected: {len(flange)}, as in {flange.table.path.name}"
            raise InvalidFile(targets.table.path, f"it has {counted(len(targets), 'row')}; {valid}")
    else:
        pictures, by_lens = shown, (shown.given is None, False)
        flange = flange[np.array([picture.row - 1 for picture in shown.used])]
        views = [view for _, view in views_of(shown.board, shown.used)]
        sightings = [sighting(shown.board, shown.lens, view, *by_lens) for view in views]
        board, optics = optics_of(shown.lens, sightings)
    sights = Sights(flange.poses, board, in_hand, optics, height)
    check_motion(sights)
    on_progress("camera and board")
    found = calibrate_hand_eye(sights)
    check_fit(found, flange, targets)
    on_progress("errors of poses that are held out")
    return HandEyeResult(found, flange.table.path.name, held_out(found), pictures)
