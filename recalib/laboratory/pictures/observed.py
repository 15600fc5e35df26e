"""What was found in pictures of a board, and the folder that `recalib calibrate` reads."""

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path

import cv2
import numpy as np

from recalib.errors import RecalibError
from recalib.files.outputs import new
from recalib.laboratory.tables.columns import POSE, Table, write_table
from recalib.laboratory.tables.measurements import OBSERVED, PICTURE, VECTORS
from recalib.vision.boards import Board
from recalib.vision.detection import Corners
from recalib.vision.lens_search import FoundLens, View, reprojection_error
from recalib.vision.lenses import Lens
from recalib.vision.views import optics_kinds

NAME = re.compile(r"[\w-]+", re.ASCII)  # of a camera or a board, as TOML and ROS take it
CORNERS, SETUP, LENS = "corners.csv", "setup.toml", "lens.yaml"
FIXED, IN_HAND = CAMERAS = "fixed", "hand"  # where a camera is
WIDE = 300  # px, of a picture on the page
LEAST = 0.5  # px: a reprojection error as small is never a reason
# What a given lens may leave, over one from the pictures: it is as good, or cannot be the same.
SIMILAR, OTHER = 1.1, 5.0
CHANCE = 10.0  # how much more a given lens leaves by chance, to a parameter, over the noise
UNSETTLED = (
    "the search for the lens was still going on when it was stopped; try: pictures that"
    " show the board tilted, near and far, and in all parts of the picture"
)


@dataclass(frozen=True)
class Picture:
    """A picture, and what came of it.

    Attributes:
        row: in the table, from 1.
        name: of its file.
        size: width and height [px]; None where it cannot be read.
        small: the same on the page, grey; None likewise.
        digest: of its pixels.
        corners: None where it is refused.
        reason: why it is refused; empty where it is not.
        error: px, the root mean square of its corners' reprojection errors.
        pose: (4, 4) m of the board in the camera.
    """

    row: int
    name: str
    size: tuple[int, int] | None = None
    small: np.ndarray | None = None
    digest: str = ""
    corners: Corners | None = None
    reason: str = ""
    error: float = np.nan
    pose: np.ndarray | None = None

    def refused(self, reason: str) -> "Picture":
        """The same, of no use."""
        return replace(self, corners=None, reason=reason, error=np.nan, pose=None)


@dataclass(frozen=True)
class Observed:
    """What was found in pictures.

    Attributes:
        table: the joints of each.
        board: which they show.
        own: the lens by these pictures.
        given: the lens, if it is known; else that by these pictures counts.
        in_hand: whether the camera is on the hand.
        pictures: all of the table.
        unlisted: names of pictures that are not in the table.
        camera, board_name: their names among several.
    """

    table: Table
    board: Board
    own: FoundLens
    given: Lens | None
    in_hand: bool
    pictures: Sequence[Picture]
    unlisted: Sequence[str]
    camera: str = "camera"
    board_name: str = "board"

    @property
    def lens(self) -> Lens:
        """Through which the pictures were taken."""
        return self.given or self.own.lens

    @property
    def used(self) -> list[Picture]:
        """Those that were not refused."""
        return [picture for picture in self.pictures if picture.corners is not None]

    @property
    def error(self) -> float:
        """px, the root mean square of all reprojection errors along an axis."""
        squares = [picture.error**2 for picture in self.used]
        return float(np.sqrt(np.mean(squares) / 2))

    @property
    def doubt(self) -> str | None:
        """What is doubtful of the lens, in a sentence."""
        return doubt_of(self.given, self.own, views_of(self.board, self.used))

    def summary(self) -> str:
        """A page of text."""
        lens, used = self.lens, self.used
        (fx, _, cx), (_, fy, cy) = lens.matrix[:2]
        source = "from these pictures"
        if self.given is not None:
            source = f"as given (one {source} would leave {self.own.error:.3f} px)"
        lines = [
            f"{len(used)} of {len(self.pictures)} pictures are used;"
            f" reprojection error {self.error:.3f} px along an axis",
            *([f"Careful: {self.doubt}"] if self.doubt else []),
            f"lens {source}: {lens.model}, focal lengths {fx:.1f} and {fy:.1f} px, principal point"
            f" ({cx:.1f}, {cy:.1f}) px, distortion"
            f" {', '.join(f'{number:.4f}' for number in lens.distortion)}",
            *(
                f"{picture.name} (row {picture.row}) is refused: {picture.reason}"
                for picture in self.pictures
                if picture.reason
            ),
        ]
        if self.unlisted:
            lines.append(f"not in {self.table.path.name}: {', '.join(self.unlisted)}")
        return "\n".join([*lines, ""])


def doubt_of(given: Lens | None, own: FoundLens, views: Sequence[View]) -> str | None:
    """What is doubtful of the lens of some pictures, in a sentence.

    Args:
        given: the lens, if it is known; else that by the pictures counts.
        own: the lens by the pictures.

    Raises RecalibError: a given lens that cannot be theirs.
    """
    if given is None:
        return None if own.converged else UNSETTLED
    left = reprojection_error(views, given)
    free = sum(2 * len(view.numbers) - 6 for _, view in views)
    surplus = free * ((left / own.error) ** 2 - 1) / len(optics_kinds(own.lens))
    if left <= SIMILAR * own.error or surplus < CHANCE:
        return None
    found = (
        f"the lens as given leaves {left:.3g} px in these pictures; one from them,"
        f" {own.lens.model}, leaves {own.error:.3g} px"
    )
    if left > max(OTHER * own.error, LEAST):
        raise RecalibError(f"{found}: it is not this camera's; try: without --lens")
    return f"{found}; is it this camera's, and are focus and zoom as they were?"


def views_of(board: Board, pictures: Sequence[Picture]) -> list[View]:
    return [(board, picture.corners) for picture in pictures if picture.corners is not None]


def write_observed(
    result: Observed, out: str | PathLike[str], write_page: Callable[[Path, Observed], None]
) -> None:
    """Write a new folder for `recalib calibrate`. Raises InvalidFile where it cannot be made."""
    with new(out, folder=True) as made:
        (made / "summary.txt").write_text(result.summary(), encoding="utf-8")
        (made / LENS).write_text(result.lens.as_ros(), encoding="utf-8")
        camera = IN_HAND if result.in_hand else FIXED
        fitted = str(result.given is None).lower()
        names = f'camera_name = "{result.camera}"\nboard_name = "{result.board_name}"\n'
        setup = f'camera = "{camera}"\nlens_from_pictures = {fitted}\n{names}\n'
        (made / SETUP).write_text(setup + result.board.described(), encoding="utf-8")
        write_table(made / OBSERVED, _measurements(result))
        corners = (
            {PICTURE: shown.name, "corner": int(number), "u [px]": f"{u:.4f}", "v [px]": f"{v:.4f}"}
            for shown in result.used
            if shown.corners is not None
            for number, (u, v) in zip(shown.corners.numbers, shown.corners.pixels, strict=True)
        )
        write_table(made / CORNERS, corners)
        write_page(made / "page.html", result)


def _measurements(result: Observed) -> Iterator[dict[str, str]]:
    """Rows of pictures and joints, with poses of the board, or of the camera in it."""
    table = result.table
    # what a live calibration measured by the same pictures is measured anew
    measured = {PICTURE, *(name for group in VECTORS for name in group)}
    joints = [name for name in table.cells if name not in measured]
    units = [f"{name} [{table.units[name]}]" if table.units[name] else name for name in joints]
    for picture in result.used:
        assert picture.pose is not None
        pose = np.linalg.inv(picture.pose) if result.in_hand else picture.pose
        turn = np.degrees(cv2.Rodrigues(pose[:3, :3])[0].ravel())
        numbers = [f"{number:.6f}" for number in (*1e3 * pose[:3, 3], *turn)]
        cells = [picture.name, *(table.cells[name][picture.row - 1] for name in joints), *numbers]
        yield dict(zip([PICTURE, *units, *POSE], cells, strict=True))
