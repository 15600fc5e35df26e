"""Hand-eye calibration from flange poses and pictures or poses of a board, and its files."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path

import numpy as np

from recalib.errors import InvalidFile
from recalib.identification.checks.moved import moved_ends
from recalib.identification.checks.sequence import Fault
from recalib.identification.hand_eye import HandEye, Sights, calibrate_hand_eye, held_out
from recalib.identification.model.optics import BOARD
from recalib.laboratory.hand_eye.mistakes import (
    FEWEST,
    WRONG,
    check_fit,
    check_motion,
    exchange_in,
)
from recalib.laboratory.hand_eye.pose_table import PoseTable
from recalib.laboratory.pictures.observe import observe, pictures_in
from recalib.laboratory.pictures.observed import LENS, PICTURE, SETUP, Observed, views_of
from recalib.laboratory.places import hand_eye_places
from recalib.laboratory.report.templates import render
from recalib.laboratory.tables.measurements import check_copies, pose_rows
from recalib.laboratory.tables.table import table_text
from recalib.spelling import counted
from recalib.vision.lens_search import moved_lens
from recalib.vision.views import optics_of, sighting

HAND_EYE, POSES = "hand_eye.toml", "poses.csv"
MOST = 1 / 3  # of the poses: if more are outliers, nothing is certain


@dataclass(frozen=True)
class HandEyeResult:
    """A hand-eye calibration with its errors.

    Attributes:
        found: where camera and board are, and how accurate the arm is.
        table: the name of the table of flange poses.
        residuals: (n, 6) m, rad, of each pose by a calibration without it.
        shown: what pictures show; None without any.
        faults: what moved amid the poses.
    """

    found: HandEye
    table: str
    residuals: np.ndarray
    shown: Observed | None
    faults: Sequence[Fault] = ()

    @property
    def good(self) -> bool:
        """Whether an arm and a camera may leave as much, in most of the poses."""
        outliers = len(self.found.outliers) / len(self.residuals)
        return bool(self.found.misfit <= WRONG and outliers <= MOST)

    @property
    def noise(self) -> float:
        """px, the root mean square of what the corners' noise leaves; NaN without pictures."""
        return float(np.sqrt(np.mean(np.square(self._alone))))

    @property
    def _alone(self) -> np.ndarray:
        if self.shown is None:
            return np.full(len(self.residuals), np.nan)
        return np.array([picture.error for picture in self.shown.used])

    @property
    def pixels(self) -> np.ndarray:
        """px (n,), what corners of each pose are off by, held out; NaN without pictures."""
        return np.hypot(self.found.sights.corners.moved(self.residuals), self._alone)

    @property
    def positions(self) -> np.ndarray:
        """m (n,), what the board is off by, held out; in pictures, across the line of sight."""
        corners = self.found.sights.corners
        if self.shown is None:
            return np.linalg.norm(self.residuals[:, :3], axis=1)
        return corners.across(corners.moved(self.residuals))

    @property
    def held_out(self) -> dict[str, float]:
        """Root mean squares of poses that were not learned from: px, m and rad.

        Outliers do not count. `robot` is what the arm's own errors leave of the pixels.
        """
        counted = np.setdiff1d(np.arange(len(self.residuals)), self.found.outliers)
        turns = np.linalg.norm(self.residuals[:, 3:], axis=1)
        sizes = {"pixels": self.pixels, "position": self.positions, "rotation": turns}
        errors = {name: float(np.sqrt(np.mean(size[counted] ** 2))) for name, size in sizes.items()}
        return errors | {"robot": float(np.sqrt(max(0.0, errors["pixels"] ** 2 - self.noise**2)))}

    @property
    def names(self) -> list[str]:
        """What each pose is called: its picture, or its row."""
        if self.shown is None:
            return [f"row {row + 1}" for row in range(len(self.residuals))]
        return [picture.name for picture in self.shown.used]

    @property
    def doubts(self) -> Iterator[str]:
        """Warnings, each without its full stop."""
        rows, in_hand = [*range(len(self.residuals))], self.found.sights.in_hand
        if self.shown is not None:
            rows = [picture.row - 1 for picture in self.shown.used]
        stands, moves = ("the camera", "the board")[:: -1 if in_hand else 1]
        for fault in self.faults:
            own = replace(fault, row=rows[fault.row])
            words = {"stands": stands, "moves": moves, "rows": rows[-1] + 1}
            none = {"folder": None, "sockets": False, "timed": False}
            yield render("fault.txt.j2", fault=own, **words, **none).strip()
        others = exchange_in(self.found, self.shown is None), self.shown and self.shown.doubt
        yield from filter(None, others)

    def summary(self) -> str:
        """A page of text."""
        return render("poses.txt.j2", **self._values())

    def files(self) -> dict[str, bytes]:
        """All files, by their names."""
        files = {
            "summary.txt": self.summary().encode(),
            HAND_EYE: render("poses.toml.j2", **self._values()).encode(),
            POSES: table_text(self._rows()),
        }
        if self.shown is not None:
            own = self.found.optics[len(BOARD) :]
            lens = (moved_lens(self.shown.lens, own) if len(own) else None) or self.shown.lens
            files |= {LENS: lens.as_ros().encode(), SETUP: self.shown.setup.encode()}
        return files

    def _values(self) -> dict[str, object]:
        links = ("flange", "base") if self.found.sights.in_hand else ("base", "flange")
        places = hand_eye_places(self.found, ("the camera", "the board"), links)
        return {
            "result": self,
            "found": self.found,
            "places": places,
            "outliers": [self.names[row] for row in self.found.outliers],
            "refused": [one for one in self.shown.pictures if one.reason] if self.shown else [],
        }

    def _rows(self) -> Iterator[dict[str, str]]:
        """For each pose that counts where the flange was, its held-out errors and its weight."""
        rows = pose_rows(self.found.sights.flange)
        each = zip(self.names, rows, self.pixels, self.positions, self.found.weights, strict=True)
        for name, pose, pixels, off, weight in each:
            corners = {"corners off [px]": f"{pixels:.3f}"} if self.shown else {}
            errors = {"board off [mm]": f"{1e3 * off:.4g}", "weight": f"{weight:.3g}"}
            yield {PICTURE: name} | pose | corners | errors


Progress = Callable[[str], None]  # called with the current step, in a line each


def pictures_at(
    flange: PoseTable,
    folder: str | PathLike[str],
    board: str | PathLike[str],
    lens: str | PathLike[str] | None = None,
    in_hand: bool = False,
    on_progress: Progress = lambda line: None,
) -> Observed:
    """The board in pictures that were taken at poses of a flange. Raises as `observe`.

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
        own = {f"{name} of the flange": cells for name, cells in flange.table.cells.items()}
        check_copies(replace(targets.table, cells={**own, **targets.table.cells}))
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
    faults, still = moved_ends(found)
    check_fit(still, flange, targets)
    on_progress("errors of poses that are held out")
    return HandEyeResult(found, flange.table.path.name, held_out(found), pictures, faults)
