"""From pictures of a board, and the joints at each, to what `recalib calibrate` reads."""

import re
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from hashlib import sha256
from os import PathLike
from pathlib import Path

import cv2
import numpy as np

from recalib.errors import InvalidFile, InvalidSetting, RecalibError
from recalib.files.outputs import new
from recalib.files.quantities import ANGLE, LENGTH
from recalib.laboratory.tables.columns import POSE, Table, read_table, write_table
from recalib.laboratory.tables.measurements import OBSERVED, PICTURE, VECTORS
from recalib.vision.boards import Board, read_board
from recalib.vision.detection import FEWEST as FEWEST_CORNERS
from recalib.vision.detection import Corners, Unusable, find_corners, read_picture
from recalib.vision.lenses import Lens, read_lens
from recalib.vision.views import FEWEST, board_pose, find_lens, good_corners, reprojection

NAME = re.compile(r"[\w-]+", re.ASCII)  # of a camera or a board, as TOML and ROS take it
CORNERS, SETUP, LENS = "corners.csv", "setup.toml", "lens.yaml"
FIXED, IN_HAND = CAMERAS = "fixed", "hand"  # where a camera is
ENOUGH = 10  # pictures
SOFTER = 2.0  # times the median blur: so much more is a picture that moved or is out of focus
WORSE = 4.0  # times the median reprojection error
LEAST = 0.5  # px: a reprojection error as small is never a reason
WIDE = 300  # px, of a picture on the page


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
        board, lens: that they show, and through which they were taken.
        fitted: whether the lens is that of these pictures.
        in_hand: whether the camera is on the hand.
        pictures: all of the table.
        strangers: names of pictures that are not in the table.
        camera, board_name: what tells them from others.
    """

    table: Table
    board: Board
    lens: Lens
    fitted: bool
    in_hand: bool
    pictures: Sequence[Picture]
    strangers: Sequence[str]
    camera: str = "camera"
    board_name: str = "board"

    @property
    def used(self) -> list[Picture]:
        """Those that were not refused."""
        return [its for its in self.pictures if its.corners is not None]

    @property
    def error(self) -> float:
        """px, the root mean square of all reprojection errors along an axis."""
        squares = [its.error**2 for its in self.used]
        return float(np.sqrt(np.mean(squares) / 2))

    def summary(self) -> str:
        """A page of text."""
        lens, used = self.lens, self.used
        (fx, _, cx), (_, fy, cy) = lens.matrix[:2]
        source = "from these pictures"
        if not self.fitted:
            source = f"as given (one {source} would leave {self.own_error:.3f} px)"
        lines = [
            f"{len(used)} of {len(self.pictures)} pictures are used;"
            f" reprojection error {self.error:.3f} px along an axis",
            f"lens {source}: focal lengths {fx:.1f} and {fy:.1f} px, principal point"
            f" ({cx:.1f}, {cy:.1f}) px, distortion"
            f" {', '.join(f'{number:.4f}' for number in lens.distortion)}",
            *(
                f"{its.name} (row {its.row}) is refused: {its.reason}"
                for its in self.pictures
                if its.reason
            ),
        ]
        if self.strangers:
            lines.append(f"not in {self.table.path.name}: {', '.join(self.strangers)}")
        return "\n".join([*lines, ""])

    @cached_property
    def own_error(self) -> float:
        """px, as `error`, with a lens from these pictures: if much less, the lens is another's."""
        views = [its.corners for its in self.used if its.corners is not None]
        own = find_lens(self.board, views, self.lens.size)
        squares = [
            np.mean(reprojection(self.board, own, view, board_pose(self.board, own, view)) ** 2)
            for view in views
        ]
        return float(np.sqrt(np.mean(squares)))


def observe(
    folder: str | PathLike[str],
    joints: str | PathLike[str],
    board: str | PathLike[str],
    lens: str | PathLike[str] | None = None,
    in_hand: bool = False,
    on_progress: Callable[[str], None] = lambda line: None,
    camera: str = "camera",
) -> Observed:
    """Find a board in pictures.

    Args:
        folder: of the pictures.
        joints: a table (CSV) with a column `picture`, which names them.
        board: its description (TOML); the file's name is that of the board.
        lens: a calibration of it (YAML of ROS or OpenCV); from the pictures unless given.
        in_hand: whether the camera is on the hand.
        on_progress: is told what is being done, in a line each.
        camera: its name, among others.

    Raises RecalibError: a name or a file that cannot be used, or too few pictures that can.
    """
    if not NAME.fullmatch(camera):
        raise InvalidSetting("--name", camera, "letters, digits, _ and -")
    given = None if lens is None else read_lens(lens)
    sheet, table = read_board(board), read_table(joints)
    if PICTURE not in table:
        raise InvalidFile(table.path, f"column {PICTURE!r} is missing: the name of each row's file")
    names = table.cells[PICTURE]
    if twice := [name for name, count in Counter(names).items() if count > 1]:
        raise InvalidFile(table.path, f"{twice[0]!r} is in more than one row")
    for name, unit in table.units.items():  # a joint that is no number is told before the search
        if quantity := next((its for its in (ANGLE, LENGTH) if unit in its.units), None):
            table.numbers(name, quantity)
    if not Path(folder).is_dir():
        raise InvalidFile(folder, "there is no such folder of pictures")
    on_progress(f"the board in {len(names)} pictures")
    pictures = [
        _searched(Path(folder) / name, row, name, sheet) for row, name in enumerate(names, 1)
    ]
    sizes = [its.size for its in pictures if its.size]
    if not sizes:
        raise InvalidFile(folder, f"none of the pictures in {table.path.name} can be read")
    size = given.size if given else Counter(sizes).most_common(1)[0][0]
    on_progress("the lens" if given is None else "poses")
    found, pictures = _posed(_compared(pictures, size, given is not None), sheet, size, given)
    told = {(Path(folder) / name).resolve() for name in names}
    others = sorted(path for path in Path(folder).iterdir() if path.resolve() not in told)
    strangers = [path.name for path in others if cv2.haveImageReader(str(path))]
    named = "_".join(NAME.findall(Path(board).stem)) or "board"
    fitted = given is None
    return Observed(table, sheet, found, fitted, in_hand, pictures, strangers, camera, named)


def write_observed(
    result: Observed, out: str | PathLike[str], write_page: Callable[[Path, Observed], None]
) -> None:
    """Write a new folder for `recalib calibrate`. Raises InvalidFile where it cannot be made."""
    with new(out, folder=True) as made:
        (made / "summary.txt").write_text(result.summary(), encoding="utf-8")
        (made / LENS).write_text(result.lens.as_ros(), encoding="utf-8")
        camera = IN_HAND if result.in_hand else FIXED
        fitted = str(result.fitted).lower()
        names = f'camera_name = "{result.camera}"\nboard_name = "{result.board_name}"\n'
        setup = f'camera = "{camera}"\nlens_from_pictures = {fitted}\n{names}\n'
        (made / SETUP).write_text(setup + result.board.described(), encoding="utf-8")
        write_table(made / OBSERVED, _measurements(result))
        corners = (
            {PICTURE: its.name, "corner": int(number), "u [px]": f"{u:.4f}", "v [px]": f"{v:.4f}"}
            for its in result.used
            if its.corners is not None
            for number, (u, v) in zip(its.corners.numbers, its.corners.pixels, strict=True)
        )
        write_table(made / CORNERS, corners)
        write_page(made / "page.html", result)


def _searched(path: Path, row: int, name: str, board: Board) -> Picture:
    """A picture with its corners, or the reason why not."""
    if not path.is_file():
        return Picture(row, name, reason="there is no such file")
    grey = read_picture(path)
    if grey is None:
        return Picture(row, name, reason="it is no picture")
    high, wide = grey.shape
    small = cv2.resize(grey, (WIDE, WIDE * high // wide), interpolation=cv2.INTER_AREA)
    picture = Picture(row, name, (wide, high), small, sha256(grey.tobytes()).hexdigest())
    try:
        return replace(picture, corners=find_corners(board, grey))
    except Unusable as error:
        return picture.refused(str(error))


def _compared(pictures: Sequence[Picture], size: tuple[int, int], by_lens: bool) -> list[Picture]:
    """Without those of another size, those that are there twice, and those that are blurred.

    Args:
        by_lens: whether the size is that of a lens which was given.
    """
    expected = "expected, as by the lens" if by_lens else "expected"
    first: dict[str, str] = {}
    done = []
    for its in pictures:
        other = first.setdefault(its.digest, its.name) if its.size else its.name
        if its.size not in (size, None):
            found, valid = (f"{wide} x {high}" for wide, high in (its.size, size))
            its = its.refused(f"it has {found} pixels; {expected}: {valid}")
        elif other != its.name:
            its = its.refused(f"it is the same picture as {other}")
        done.append(its)
    most = SOFTER * np.median([its.corners.softness for its in done if its.corners] or [np.inf])
    return [
        its.refused(f"it is blurred by {its.corners.softness:.1f} px, twice as much as others")
        if its.corners and its.corners.softness > most
        else its
        for its in done
    ]


def _posed(
    pictures: list[Picture], board: Board, size: tuple[int, int], lens: Lens | None
) -> tuple[Lens, list[Picture]]:
    """The lens, and the pictures with their poses; those that fit badly are refused."""
    while True:
        views = [its.corners for its in pictures if its.corners is not None]
        if len(views) < max(ENOUGH, FEWEST):
            first = next((f"; {its.name}: {its.reason}" for its in pictures if its.reason), "")
            raise RecalibError(
                f"{len(views)} of {len(pictures)} pictures can be used; expected: at least"
                f" {ENOUGH}{first}"
            )
        found = lens or find_lens(board, views, size)
        pictures = [_measured(its, board, found) for its in pictures]
        most = max(WORSE * np.nanmedian([its.error for its in pictures]), LEAST)
        bad = [its.error > most for its in pictures]
        pictures = [
            its.refused(f"its corners are off by {its.error:.2f} px: it moved, or is not flat")
            if wrong
            else its
            for its, wrong in zip(pictures, bad, strict=True)
        ]
        if sum(its.corners is not None for its in pictures) == len(views):
            return found, pictures


def _measured(picture: Picture, board: Board, lens: Lens) -> Picture:
    if picture.corners is None:
        return picture
    corners = good_corners(board, lens, picture.corners)
    if len(corners.numbers) < FEWEST_CORNERS:
        all_, valid = len(picture.corners.numbers), f"at least {FEWEST_CORNERS}"
        return picture.refused(f"{len(corners.numbers)} of {all_} corners fit; expected: {valid}")
    pose = board_pose(board, lens, corners)
    squares = np.sum(reprojection(board, lens, corners, pose) ** 2, axis=1)
    return replace(picture, corners=corners, pose=pose, error=float(np.sqrt(squares.mean())))


def _measurements(result: Observed) -> Iterator[dict[str, str]]:
    """Rows of pictures and joints, with poses of the board, or of the camera in it."""
    table = result.table
    # what a live calibration measured by the same pictures is measured anew
    measured = {PICTURE, *(name for group in VECTORS for name in group)}
    joints = [name for name in table.cells if name not in measured]
    units = [f"{name} [{table.units[name]}]" if table.units[name] else name for name in joints]
    for its in result.used:
        assert its.pose is not None
        pose = np.linalg.inv(its.pose) if result.in_hand else its.pose
        turn = np.degrees(cv2.Rodrigues(pose[:3, :3])[0].ravel())
        numbers = [f"{number:.6f}" for number in (*1e3 * pose[:3, 3], *turn)]
        cells = [its.name, *(table.cells[name][its.row - 1] for name in joints), *numbers]
        yield dict(zip([PICTURE, *units, *POSE], cells, strict=True))
