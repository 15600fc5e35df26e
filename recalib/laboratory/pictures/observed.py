"""What was found in pictures of a board, and the folder that `recalib calibrate` reads."""

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

NAME = re.compile(r"[\w-]+", re.ASCII)  # of a camera or a board, as TOML and ROS take it
OBSERVED, CORNERS, SETUP, LENS = "measurements.csv", "corners.csv", "setup.toml", "lens.yaml"
WIDE = 300  # px, of a picture on the page
LEAST = 0.5  # px: a reprojection error as small is never a reason
# What a given lens may leave, over one from the pictures: it is as good, or cannot be the same.
SIMILAR, OTHER = 1.1, 5.0
CHANCE = 10.0  # how much more a given lens leaves by chance, to a parameter, over the noise
SURE, ZOOMED = 5.0, 0.01  # deviations of focal lengths, and the part by which none may be off
UNSETTLED = (
    "the estimation of the lens did not converge; try: pictures that"
    " show the board tilted, near and far, and in all parts of the picture"
)


@dataclass(frozen=True)
class Picture:
    """A picture and the corners found in it."""

    row: int  # in the table, from 1
    name: str  # of the file
    size: tuple[int, int] | None = None  # width and height [px]; None if it cannot be read
    small: np.ndarray | None = None  # a small grey copy for the page; None likewise
    digest: str = ""  # of the pixels
    corners: Corners | None = None  # None if it is refused
    reason: str = ""  # why it is refused; empty if it is not
    error: float = np.nan  # px, the root mean square of the corners' reprojection errors
    pose: np.ndarray | None = None  # (4, 4) m of the board in the camera

    def refused(self, reason: str) -> "Picture":
        return replace(self, corners=None, reason=reason, error=np.nan, pose=None)


@dataclass(frozen=True)
class Observed:
    """Corners, lens and refusals of a folder of pictures."""

    table: Table  # with the joints of each picture
    board: Board  # in all pictures
    own: FoundLens  # estimated from these pictures
    given: Lens | None  # if it is known; otherwise the estimated one counts
    in_hand: bool  # whether the camera is on the hand
    pictures: Sequence[Picture]  # all of the table
    unlisted: Sequence[str]  # names of pictures that are not in the table
    camera: str = "camera"  # its name among several
    board_name: str = "board"  # likewise

    @property
    def lens(self) -> Lens:
        """The lens in all pictures."""
        return self.given or self.own.lens

    @property
    def used(self) -> list[Picture]:
        """The pictures that were not refused."""
        return [picture for picture in self.pictures if picture.corners is not None]

    @property
    def error(self) -> float:
        """px, the root mean square of all reprojection errors along an axis."""
        squares = [picture.error**2 for picture in self.used]
        return float(np.sqrt(np.mean(squares) / 2))

    @property
    def doubt(self) -> str | None:
        return doubt_of(self.given, self.own, views_of(self.board, self.used))

    def summary(self) -> str:
        return render("observed.txt.j2", result=self, used=self.used)

    @property
    def setup(self) -> str:
        """A TOML of the board, the camera and the lens's source."""
        return (
            f'camera = "{IN_HAND if self.in_hand else FIXED}"\n'
            f"lens_from_pictures = {str(self.given is None).lower()}\n"
            f'camera_name = "{self.camera}"\nboard_name = "{self.board_name}"\n\n'
        ) + self.board.described()

    def files(self) -> dict[str, bytes]:
        """The files of a folder for `recalib calibrate`, by their names."""
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
        """Rows of pictures and joints, with poses of the board, or of the camera in it."""
        table = self.table
        # what a live calibration measured by the same pictures is measured anew
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
    """What is doubtful about the lens of some pictures, in a sentence without its full stop.

    It is the given lens, or else their own, which is estimated from them.

    Raises RecalibError: a given lens that cannot be theirs.
    """
    if given is None:
        return None if own.converged else UNSETTLED
    left = reprojection_error(views, given)
    free = sum(2 * len(view.numbers) - 6 for _, view in views)
    surplus = free * ((left / own.error) ** 2 - 1) / len(optics_kinds(own.lens))
    known, focal = (lens.matrix.diagonal()[:2] for lens in (given, own.lens))
    off = np.abs(known - focal)
    sure = (off > SURE * own.deviations) & own.converged
    if not sure.any() and (left <= SIMILAR * own.error or surplus < CHANCE):
        return None
    lengths, others = (f"{x:.1f} and {y:.1f}" for x, y in (known, focal))
    found = (
        f"the given lens has focal lengths of {lengths} px, and a reprojection error of"
        f" {left:.3g} px in these pictures; one estimated from them, {own.lens.model},"
        f" has {others} px (deviation {own.deviations.max():.2g} px), and {own.error:.3g} px"
    )
    if left > max(OTHER * own.error, LEAST) or (sure & (off > ZOOMED * focal)).any():
        raise RecalibError(f"{found}: it is not this camera's; try: without --lens")
    return f"{found}; check that it belongs to this camera and that focus and zoom are unchanged"


def views_of(board: Board, pictures: Sequence[Picture]) -> list[View]:
    """The corners in pictures that were not refused, each with the board."""
    return [(board, picture.corners) for picture in pictures if picture.corners is not None]
