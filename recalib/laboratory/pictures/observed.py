"""Corners, lens and refusals of pictures of a board, and the folder for `recalib calibrate`."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from recalib.errors import RecalibError
from recalib.laboratory.options import FIXED, IN_HAND
from recalib.laboratory.report.templates import render
from recalib.laboratory.tables.columns import ERRORS, NOMINAL, PICTURE, POSITIONS, ROTATIONS
from recalib.laboratory.tables.measurements import pose_rows
from recalib.laboratory.tables.table import Table, table_text
from recalib.vision.boards import Board
from recalib.vision.detection import Corners
from recalib.vision.lens_search import FoundLens, View, reprojection_error
from recalib.vision.lenses import Lens
from recalib.vision.views import optics_kinds

NAME = re.compile(r"[\w-]+", re.ASCII)  # of a camera or a board, as TOML and ROS allow
OBSERVED, CORNERS, SETUP, LENS = "measurements.csv", "corners.csv", "setup.toml", "lens.yaml"
WIDE = 300  # px, width of a picture on the page
LEAST = 0.5  # px: a smaller reprojection error is never a reason for refusal
# reprojection error of a given lens over that of the estimated one: equally good, another lens
SIMILAR, OTHER = 1.1, 5.0
CHANCE = 10.0  # surplus of squared errors for each parameter, over the noise, that chance explains
SURE, ZOOMED = 5.0, 0.01  # standard deviations of a focal length; largest relative difference
UNSETTLED = (
    "the estimation of the lens did not converge; try: pictures that"
    " show the board tilted, near and far, and in all parts of the picture"
)


@dataclass(frozen=True)
class Picture:
    """A picture and the corners found in it."""

    row: int  # in the table, counted from 1
    name: str  # of the file
    size: tuple[int, int] | None = None  # width and height [px]; None if it cannot be read
    small: np.ndarray | None = None  # a small grey copy for the page; None if it cannot be read
    digest: str = ""  # of the pixels
    corners: Corners | None = None  # None if it is refused
    reason: str = ""  # for the refusal; empty if it is used
    error: float = np.nan  # px, the root mean square of the corners' reprojection errors
    pose: np.ndarray | None = None  # (4, 4) m of the board in the camera

    def refused(self, reason: str) -> "Picture":
        return replace(self, corners=None, reason=reason, error=np.nan, pose=None)


@dataclass(frozen=True)
class Observed:
    """Corners, lens and refusals of a folder of pictures."""

    table: Table  # with the joints of each picture
    board: Board  # in all pictures
    own: FoundLens  # the lens estimated from these pictures
    given: Lens | None  # by the user; None to use the estimated one
    in_hand: bool  # whether the camera is on the hand
    pictures: Sequence[Picture]  # all in the table
    unlisted: Sequence[str]  # names of pictures that are not in the table
    camera: str = "camera"  # name of the camera, if there are several
    board_name: str = "board"  # name of the board, if there are several

    @property
    def lens(self) -> Lens:
        """The lens of all pictures: the given one, or else the estimated one."""
        return self.given or self.own.lens

    @property
    def used(self) -> list[Picture]:
        """The pictures that were not refused."""
        return [picture for picture in self.pictures if picture.corners is not None]

    @property
    def error(self) -> float:
        """The root mean square of all reprojection errors along an axis [px]."""
        squares = [picture.error**2 for picture in self.used]
        return float(np.sqrt(np.mean(squares) / 2))

    @property
    def doubt(self) -> str | None:
        return doubt_of(self.given, self.own, views_of(self.board, self.used))

    def summary(self) -> str:
        return render("observed.txt.j2", result=self, used=self.used)

    @property
    def setup(self) -> str:
        """A TOML that describes the board, the camera and the source of the lens."""
        return (
            f'camera = "{IN_HAND if self.in_hand else FIXED}"\n'
            f"lens_from_pictures = {str(self.given is None).lower()}\n"
            f'camera_name = "{self.camera}"\nboard_name = "{self.board_name}"\n\n'
        ) + self.board.described()

    def files(self) -> dict[str, bytes]:
        """The files of a folder for `recalib calibrate`, by name."""
        corners = (
            {PICTURE: shown.name, "corner": int(number), "u [px]": f"{u:.4f}", "v [px]": f"{v:.4f}"}
            for shown in self.used
            if shown.corners is not None
            for number, (u, v) in zip(shown.corners.numbers, shown.corners.pixels, strict=True)
        )
        return {
            "summary.txt": self.summary().encode(),
            LENS: self.lens.as_ros().encode(),
            SETUP: self.setup.encode(),
            OBSERVED: table_text(self._measurements()),
            CORNERS: table_text(corners),
        }

    def _measurements(self) -> Iterator[dict[str, str]]:
        """Rows of pictures and joints, with poses of the board in the camera, or the inverse."""
        table = self.table
        # poses that a live calibration measured in the same pictures are replaced
        vectors = (POSITIONS, *ROTATIONS, NOMINAL, ERRORS)
        measured = {PICTURE, *(name for kind in vectors for name in kind.headings)}
        joints = [name for name in table.cells if name not in measured]
        units = [f"{name} [{table.units[name]}]" if table.units[name] else name for name in joints]
        poses = np.array([picture.pose for picture in self.used])
        rows = pose_rows(np.linalg.inv(poses) if self.in_hand else poses)
        for picture, pose in zip(self.used, rows, strict=True):
            cells = [table.cells[name][picture.row - 1] for name in joints]
            yield {PICTURE: picture.name} | dict(zip(units, cells, strict=True)) | pose


def doubt_of(given: Lens | None, own: FoundLens, views: Sequence[View]) -> str | None:
    """A warning about the lens of pictures, without its full stop; None if there is none.

    It is about the given lens, or else about the lens estimated from these pictures.

    Raises RecalibError if the given lens cannot be that of the pictures.
    """
    if given is None:
        return None if own.converged else UNSETTLED
    error = reprojection_error(views, given)
    free = sum(2 * len(view.numbers) - 6 for _, view in views)
    surplus = free * ((error / own.error) ** 2 - 1) / len(optics_kinds(own.lens))
    known, focal = (lens.matrix.diagonal()[:2] for lens in (given, own.lens))
    off = np.abs(known - focal)
    sure = (off > SURE * own.deviations) & own.converged
    if not sure.any() and (error <= SIMILAR * own.error or surplus < CHANCE):
        return None
    lengths, others = (f"{x:.1f} and {y:.1f}" for x, y in (known, focal))
    found = (
        f"the given lens has focal lengths of {lengths} px, and a reprojection error of"
        f" {error:.3g} px in these pictures; one estimated from them, {own.lens.model},"
        f" has {others} px (deviation {own.deviations.max():.2g} px), and {own.error:.3g} px"
    )
    if error > max(OTHER * own.error, LEAST) or (sure & (off > ZOOMED * focal)).any():
        raise RecalibError(f"{found}: it is not this camera's; try: without --lens")
    return f"{found}; check that it belongs to this camera and that focus and zoom are unchanged"


def views_of(board: Board, pictures: Sequence[Picture]) -> list[View]:
    """The corners in pictures that were not refused, each paired with the board."""
    return [(board, picture.corners) for picture in pictures if picture.corners is not None]
