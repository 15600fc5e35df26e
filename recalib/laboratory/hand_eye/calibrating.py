"""Hand-eye calibration from flange poses and pictures or poses of a board; output files."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path, PureWindowsPath

import numpy as np

from recalib.errors import InvalidFile
from recalib.identification.checks.moved import moved_ends
from recalib.identification.checks.sequence import Fault
from recalib.identification.hand_eye import calibrate_hand_eye, held_out, upended
from recalib.identification.model.hand_eye_model import ENDS, HandEye, Sights
from recalib.identification.model.optics import BOARD
from recalib.laboratory.calibrate import Progress
from recalib.laboratory.hand_eye.pose_checks import (
    FEWEST,
    WRONG,
    check_fit,
    check_motion,
    exchange_in,
)
from recalib.laboratory.hand_eye.pose_table import PoseTable
from recalib.laboratory.pictures.observe import observe, pictures_in
from recalib.laboratory.pictures.observed import LENS, SETUP, Observed, views_of
from recalib.laboratory.places import hand_eye_places
from recalib.laboratory.report.templates import render
from recalib.laboratory.tables.columns import PICTURE
from recalib.laboratory.tables.measurements import check_copies, pose_rows
from recalib.laboratory.tables.table import table_text
from recalib.spelling import counted
from recalib.vision.lens_search import moved_lens
from recalib.vision.views import optics_of, sighting

HAND_EYE, POSES = "hand_eye.toml", "poses.csv"
ROUNDS, SETTLED = 4, 0.3  # of the lens; the largest step at convergence, in deviations
MOST = 1 / 3  # of the poses: if more are outliers, the result cannot be trusted


def pictures_at(
    flange: PoseTable,
    folder: Path,
    board: Path,
    lens: Path | None,
    in_hand: bool,
    progress: Progress,
) -> Observed:
    """The board in pictures that were taken at flange poses. Raises like `observe`.

    Without a column of their names, the rows of the table follow the order of these names.
    """
    table = flange.table
    names = [path.name for path in pictures_in(folder)] if folder.is_dir() else []
    bare = ([PureWindowsPath(cell).name for cell in each] for each in table.cells.values())
    cells = next((each for each in bare if {*each} <= {*names}), None)
    if cells is None and PICTURE not in table and len(names) != len(flange):
        counts = f"it has {counted(len(flange), 'row')}, and {folder} has {len(names)} pictures"
        raise InvalidFile(table.path, f"{counts}; try: a column 'picture' with their names")
    cells = cells or table.cells.get(PICTURE, names)
    table = replace(table, cells={PICTURE: cells}, units={PICTURE: ""})
    return observe(folder, table, board, lens, in_hand, progress, least=FEWEST)


def calibrate_poses(
    flange: PoseTable,
    shown: Observed | PoseTable,
    in_hand: bool,
    height: tuple[float, float] | None,
    on_progress: Progress,
) -> tuple[dict[str, bytes], bool]:
    """Calibrate the poses of camera and board: all files by name, and whether most poses fit.

    Args:
        flange: poses of the flange in the base.
        shown: pictures of the board, or poses of the target in the camera; row by row.
        height: m, the board's height and its standard deviation; see `Sights`.

    Raises RecalibError if the poses do not determine the result, or are likely mistaken.
    """
    pictures = targets = doubt = None
    if isinstance(shown, PoseTable):
        targets, sights = shown, Sights(flange.poses, shown.poses, in_hand, None, height)
        if len(flange) != len(targets):
            valid = f"expected: {len(flange)}, as in {flange.table.path.name}"
            raise InvalidFile(targets.table.path, f"it has {counted(len(targets), 'row')}; {valid}")
        flanges = {f"{name} of the flange": cells for name, cells in flange.table.cells.items()}
        check_copies(replace(targets.table, cells={**flanges, **targets.table.cells}))
    else:
        doubt = shown.doubt  # checked first, so that a wrong lens does not look like wrong poses
        pictures, flange = shown, flange[np.array([picture.row - 1 for picture in shown.used])]
        sights = seen(shown, flange.poses, height)
    check_motion(sights)
    on_progress("camera and board")
    found = calibrate_hand_eye(sights)
    if pictures is not None:
        pictures, found = with_lens(pictures, found)
    faults, corrected = moved_ends(found)
    check_fit(corrected, flange, targets)
    on_progress("errors of poses that are held out")
    good = found.misfit <= WRONG and len(found.outliers) / len(flange) <= MOST
    doubts = [*_doubts(found, pictures, faults, doubt)]
    return _files(found, flange.table.path.name, pictures, doubts, good), good


def seen(shown: Observed, flange: np.ndarray, height: tuple[float, float] | None) -> Sights:
    """What pictures show at the flange's poses (n, 4, 4)."""
    views = [view for _, view in views_of(shown.board, shown.used)]
    if shown.board.same_upside_down:
        last = len(shown.board.points) - 1
        turned = upended(flange, np.array([picture.pose for picture in shown.used]))
        views = [
            replace(view, numbers=np.where(half, last - view.numbers, view.numbers))
            for view, half in zip(views, turned, strict=True)
        ]
    sightings = [
        sighting(shown.board, shown.lens, view, shown.given is None, False) for view in views
    ]
    board, optics = optics_of(shown.lens, sightings)
    return Sights(flange, board, shown.in_hand, optics, height)


def with_lens(shown: Observed, found: HandEye) -> tuple[Observed, HandEye]:
    """The same by a lens near that of the fit: residuals are linear in small corrections only."""
    for _ in range(ROUNDS):
        step = found.optics[len(BOARD) :]
        sizes = np.sqrt(found.covariance.diagonal()[ENDS + len(BOARD) :])
        settled = (np.abs(step) <= SETTLED * sizes).all()
        if settled or (lens := moved_lens(shown.lens, step)) is None:
            break
        shown = replace(shown, own=replace(shown.own, lens=lens))
        found = calibrate_hand_eye(seen(shown, found.sights.flange, found.sights.height))
    return shown, found


def _doubts(
    found: HandEye, shown: Observed | None, faults: Sequence[Fault], lens: str | None
) -> Iterator[str]:
    """Warnings, each without its full stop: about movements, poses and the lens."""
    rows, in_hand = [*range(len(found.sights))], found.sights.in_hand
    if shown is not None:
        rows = [picture.row - 1 for picture in shown.used]
    stands, moves = ("the camera", "the board")[:: -1 if in_hand else 1]
    for fault in faults:
        renumbered = replace(fault, row=rows[fault.row])
        words = {"stands": stands, "moves": moves, "rows": rows[-1] + 1}
        none = {"folder": None, "sockets": False, "timed": False}
        yield render("fault.txt.j2", fault=renumbered, **words, **none).strip()
    yield from filter(None, (exchange_in(found, shown is None), lens))


def _files(
    found: HandEye, table: str, shown: Observed | None, doubts: Sequence[str], good: bool
) -> dict[str, bytes]:
    """All files, by name, of a calibration from a table and, if there are any, pictures.

    The error of each pose is from a calibration without it. Mean squares omit outliers.
    """
    sights, residuals = found.sights, held_out(found)
    moved = sights.corners.moved(residuals)
    if shown is None:
        names, noise = [f"row {row + 1}" for row in range(len(moved))], np.full(len(moved), np.nan)
        positions = np.linalg.norm(residuals[:, :3], axis=1)
    else:
        names = [picture.name for picture in shown.used]
        noise = np.array([picture.error for picture in shown.used])
        positions = sights.corners.across(moved)  # across the line of sight
    pixels = np.hypot(moved, noise)
    fitting = np.setdiff1d(np.arange(len(moved)), found.outliers)
    total, alone = _rms(pixels[fitting]), _rms(noise)
    links = ("flange", "base") if sights.in_hand else ("base", "flange")
    values = {
        "found": found,
        "table": table,
        "shown": shown,
        "doubts": doubts,
        "good": good,
        "places": hand_eye_places(found, ("the camera", "the board"), links),
        "pixels": total,
        "position": _rms(positions[fitting]),
        "rotation": _rms(np.linalg.norm(residuals[fitting, 3:], axis=1)),
        "noise": alone,
        "robot": np.sqrt(max(0.0, total**2 - alone**2)),  # due to the arm's own errors
        "distance": np.median(np.linalg.norm(sights.board[:, :3, 3], axis=1)),
        "outliers": [names[row] for row in found.outliers],
    }
    rows = []
    each = zip(names, pose_rows(sights.flange), pixels, positions, found.weights, strict=True)
    for name, pose, pixel, off, weight in each:
        corners = {"corners off [px]": f"{pixel:.3f}"} if shown else {}
        errors = {"board off [mm]": f"{1e3 * off:.4g}", "weight": f"{weight:.3g}"}
        rows.append({PICTURE: name} | pose | corners | errors)
    files = {
        "summary.txt": render("poses.txt.j2", **values).encode(),
        HAND_EYE: render("poses.toml.j2", **values).encode(),
        POSES: table_text(rows),
    }
    if shown is not None:
        correction = found.optics[len(BOARD) :]
        lens = (moved_lens(shown.lens, correction) if len(correction) else None) or shown.lens
        files |= {LENS: lens.as_ros().encode(), SETUP: shown.setup.encode()}
    return files


def _rms(errors: np.ndarray) -> float:
    return float(np.sqrt(np.mean(errors**2)))
