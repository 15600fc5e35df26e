"""Search of a board in pictures, calibration of the lens, and refusal of bad pictures."""

import os
import re
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import replace
from hashlib import sha256
from pathlib import Path

import cv2
import numpy as np

from recalib.errors import InvalidFile, InvalidSetting, RecalibError
from recalib.files.outputs import AnyPath
from recalib.files.quantities import ANGLE, LENGTH
from recalib.laboratory.pictures.observed import (
    LEAST,
    NAME,
    WIDE,
    Observed,
    Picture,
    doubt_of,
    views_of,
)
from recalib.laboratory.tables.columns import PICTURE
from recalib.laboratory.tables.table import Table, read_table
from recalib.vision.boards import FEWEST as FEWEST_CORNERS
from recalib.vision.boards import Board, read_board
from recalib.vision.detection import Unusable, find_corners, read_picture
from recalib.vision.lens_search import FEWEST, FoundLens, find_lens
from recalib.vision.lenses import Lens, read_lens
from recalib.vision.views import board_pose, good_corners, reprojection

ENOUGH = 10  # usable pictures
SOFTER = 2.0  # times the median blur: a picture with more moved or is out of focus
DIGITS = re.compile(r"(\d+)")
WORSE = 4.0  # times the median reprojection error: a picture with more is refused


def observe(
    folder: AnyPath,
    joints: AnyPath | Table,
    board: AnyPath,
    lens: AnyPath | None = None,
    in_hand: bool = False,
    on_progress: Callable[[str], None] = lambda line: None,
    camera: str = "camera",
    least: int = ENOUGH,
) -> Observed:
    """Find a board in pictures.

    Args:
        joints: a table (CSV) with joint coordinates and a column `picture` with file names.
        board: the description of the board (TOML); the board is named after this file.
        lens: a calibration of the lens (YAML of ROS or OpenCV; default: estimated).
        camera: name of the camera; needed if there are several.
        least: the smallest number of usable pictures.

    Raises RecalibError: a name or a file that cannot be used, or too few usable pictures.
    """
    if not NAME.fullmatch(camera):
        raise InvalidSetting("--name", camera, "letters, digits, _ and -")
    given = None if lens is None else read_lens(lens)
    sheet, table = read_board(board), joints if isinstance(joints, Table) else read_table(joints)
    if PICTURE not in table:
        raise InvalidFile(table.path, f"column {PICTURE!r} is missing: the name of each row's file")
    names = table.cells[PICTURE]
    if twice := [name for name, count in Counter(names).items() if count > 1]:
        raise InvalidFile(table.path, f"{twice[0]!r} is in more than one row")
    for name, unit in table.units.items():  # refuse invalid joints before the long search
        if quantity := next((kind for kind in (ANGLE, LENGTH) if unit in kind.units), None):
            table.numbers(name, quantity)
    if not Path(folder).is_dir():
        raise InvalidFile(folder, "there is no such folder")
    on_progress(f"the board in {len(names)} pictures")
    pictures = [
        _searched(Path(folder) / name, row, name, sheet) for row, name in enumerate(names, 1)
    ]
    sizes = [picture.size for picture in pictures if picture.size]
    if not sizes:
        raise InvalidFile(folder, f"none of the pictures in {table.path.name} can be read")
    size = given.size if given else Counter(sizes).most_common(1)[0][0]
    on_progress("the lens" if given is None else "poses")
    compared = _compared(pictures, size, given is not None)
    estimated, pictures = _posed(compared, sheet, size, given, least)
    listed = {os.path.abspath(Path(folder) / name) for name in names}
    others = [path.name for path in pictures_in(folder) if os.path.abspath(path) not in listed]
    named = "_".join(NAME.findall(Path(board).stem)) or "board"
    return Observed(table, sheet, estimated, given, in_hand, pictures, others, camera, named)


def pictures_in(folder: AnyPath) -> list[Path]:
    """The pictures in a folder, sorted by name with numbers by value: 2.png precedes 10.png."""
    files = (path for path in Path(folder).iterdir() if path.is_file())  # a pipe may never end
    return sorted(
        (path for path in files if cv2.haveImageReader(str(path))),
        key=lambda path: [
            int(part) if part.isdecimal() else part for part in DIGITS.split(path.name)
        ],
    )


def _searched(path: Path, row: int, name: str, board: Board) -> Picture:
    """A picture with its corners, or with the reason why it is refused."""
    picture = Picture(row, name)
    try:
        grey = read_picture(path)
        high, wide = grey.shape
        size = WIDE, max(1, WIDE * high // wide)
        small = cv2.resize(grey, size, interpolation=cv2.INTER_AREA)
        picture = Picture(row, name, (wide, high), small, sha256(grey.tobytes()).hexdigest())
        return replace(picture, corners=find_corners(board, grey))
    except Unusable as error:
        return picture.refused(str(error))


def _compared(pictures: Sequence[Picture], size: tuple[int, int], by_lens: bool) -> list[Picture]:
    """Refuse pictures that are repeated, blurred, or not of this size (`by_lens`: of the lens)."""
    expected = "expected, as by the lens" if by_lens else "expected"
    first: dict[str, str] = {}
    done = []
    for picture in pictures:
        other = first.setdefault(picture.digest, picture.name) if picture.size else picture.name
        if picture.size not in (size, None):
            found, valid = (f"{wide} x {high}" for wide, high in (picture.size, size))
            picture = picture.refused(f"it has {found} pixels; {expected}: {valid}")
        elif other != picture.name:
            picture = picture.refused(f"it is the same picture as {other}")
        done.append(picture)
    blurs = [picture.corners.softness for picture in done if picture.corners]
    most = SOFTER * np.median(blurs or [np.inf])
    return [
        picture.refused(
            f"it is blurred by {picture.corners.softness:.1f} px, twice as much as others"
        )
        if picture.corners and picture.corners.softness > most
        else picture
        for picture in done
    ]


def _posed(
    pictures: list[Picture], board: Board, size: tuple[int, int], given: Lens | None, least: int
) -> tuple[FoundLens, list[Picture]]:
    """The lens estimated from pictures, and the pictures with poses; bad fits are refused."""
    while True:
        views = views_of(board, pictures)
        if len(views) < max(least, FEWEST):
            first = next((f"; {one.name}: {one.reason}" for one in pictures if one.reason), "")
            raise RecalibError(
                f"{len(views)} of {len(pictures)} pictures can be used; expected: at least"
                f" {max(least, FEWEST)}{first}"
            )
        estimated = find_lens(views, size)
        if given is not None:
            doubt_of(given, estimated, views)
        pictures = [_measured(picture, board, given or estimated.lens) for picture in pictures]
        most = max(WORSE * np.nanmedian([picture.error for picture in pictures]), LEAST)
        pictures = [
            picture.refused(
                f"its corners are {picture.error:.2f} px off: the board moved, or is not flat"
            )
            if picture.error > most
            else picture
            for picture in pictures
        ]
        good = views_of(board, pictures)
        if [len(view.numbers) for _, view in good] == [len(view.numbers) for _, view in views]:
            return estimated, pictures  # else the lens is estimated again, from the corners left


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
