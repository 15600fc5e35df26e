"""What a hand-eye calibration found, and its files."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from recalib.identification.hand_eye_model import HandEye
from recalib.identification.model.optics import BOARD
from recalib.laboratory.hand_eye.mistakes import WRONG
from recalib.laboratory.pictures.observed import FIXED, IN_HAND, LENS, PICTURE, SETUP, Picture
from recalib.laboratory.places import Place
from recalib.laboratory.report.folder import pose_rows
from recalib.laboratory.report.forms import Forms
from recalib.laboratory.report.templates import render
from recalib.laboratory.tables.table import table_text
from recalib.vision.boards import Board
from recalib.vision.lens_search import moved_lens
from recalib.vision.lenses import Lens

HAND_EYE, POSES = "hand_eye.toml", "poses.csv"
MOST = 1 / 3  # of the poses: if more are outliers, nothing is certain


class Shown(NamedTuple):
    """What pictures show.

    Attributes:
        board, lens: in all of them; the lens is that for which the optics are zero.
        fitted: whether the lens was found from them.
        pictures: all, also those that were refused.
        doubt: what is doubtful about the lens; None if nothing is.
    """

    board: Board
    lens: Lens
    fitted: bool
    pictures: Sequence[Picture]
    doubt: str | None


@dataclass(frozen=True)
class HandEyeResult:
    """A hand-eye calibration with its errors.

    Attributes:
        found: where camera and board are, and how accurate the arm is.
        table: the name of the table of flange poses.
        residuals: (n, 6) m, rad, of each pose by a calibration without it.
        shown: None without pictures.
    """

    found: HandEye
    table: str
    residuals: np.ndarray
    shown: Shown | None

    @property
    def good(self) -> bool:
        """Whether an arm and a camera may leave as much, in most of the poses."""
        outliers = len(self.found.outliers) / len(self.residuals)
        return bool(self.found.misfit <= WRONG and outliers <= MOST)

    @property
    def places(self) -> tuple[Place, Place]:
        """The camera and the board."""
        found, in_hand = self.found, self.found.sights.in_hand
        links = ("flange", "base") if in_hand else ("base", "flange")
        names = "the camera", "the board"
        camera, board = (
            Place(name, link, True, pose, found.deviations(part), found.deviations(part))
            for part, (name, link, pose) in enumerate(
                zip(names, links, (found.camera, found.board), strict=True)
            )
        )
        return camera, board

    @property
    def noise(self) -> float:
        """px, the root mean square of what the corners' noise alone leaves in a picture."""
        return float(np.sqrt(np.mean(np.square(self._alone)))) if self.shown else np.nan

    @property
    def _alone(self) -> np.ndarray:
        assert self.shown is not None
        return np.array([picture.error for picture in self.shown.pictures if picture.corners])

    @property
    def pixels(self) -> np.ndarray:
        """px (n,), what corners of each pose are off by, held out; NaN without pictures."""
        if self.shown is None:
            return np.full(len(self.residuals), np.nan)
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

        Outliers do not count.
        """
        counted = np.setdiff1d(np.arange(len(self.residuals)), self.found.outliers)
        turns = np.linalg.norm(self.residuals[:, 3:], axis=1)
        sizes = {"pixels": self.pixels, "position": self.positions, "rotation": turns}
        return {name: float(np.sqrt(np.mean(size[counted] ** 2))) for name, size in sizes.items()}

    @property
    def own_share(self) -> float:
        """px, what the arm's own errors leave of the held-out error, beyond the corners' noise."""
        return float(np.sqrt(max(0.0, self.held_out["pixels"] ** 2 - self.noise**2)))

    @property
    def lens(self) -> Lens | None:
        """The lens that goes with the places."""
        if self.shown is None:
            return None
        own = self.found.optics[len(BOARD) :]
        return (moved_lens(self.shown.lens, own) if len(own) else None) or self.shown.lens

    @property
    def names(self) -> list[str]:
        """What each pose is called: its picture, or its row."""
        if self.shown is None:
            return [f"row {row + 1}" for row in range(len(self.residuals))]
        return [picture.name for picture in self.shown.pictures if picture.corners]

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
        if self.shown is not None and self.lens is not None:
            camera = f'camera = "{IN_HAND if self.found.sights.in_hand else FIXED}"\n'
            files |= {LENS: self.lens.as_ros().encode()}
            files |= {SETUP: (camera + "\n" + self.shown.board.described()).encode()}
        return files

    def _values(self) -> dict[str, object]:
        names = self.names
        return {
            "result": self,
            "found": self.found,
            "forms": [Forms(place) for place in self.places],
            "outliers": [names[row] for row in self.found.outliers],
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
