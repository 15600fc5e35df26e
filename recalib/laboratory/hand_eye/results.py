"""What a hand-eye calibration found, and its files."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from recalib.identification.hand_eye import HandEye
from recalib.identification.model.optics import BOARD
from recalib.laboratory.hand_eye.mistakes import WRONG
from recalib.laboratory.pictures.observed import LENS, PICTURE, SETUP, Observed
from recalib.laboratory.places import hand_eye_places
from recalib.laboratory.report.folder import pose_rows
from recalib.laboratory.report.templates import render
from recalib.laboratory.tables.table import table_text
from recalib.vision.lens_search import moved_lens

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
    """

    found: HandEye
    table: str
    residuals: np.ndarray
    shown: Observed | None

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
