"""What `observe` wrote, as observations of an arm: poses and what its pixels make of them.

Each folder has pictures of one board by one camera. Folders may share a camera, or a board.
"""

import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from recalib.errors import InvalidFile
from recalib.files.quantities import Quantity
from recalib.files.storage import read_file
from recalib.identification.model.observations import Observations
from recalib.identification.model.optics import BOARD, Optics
from recalib.laboratory.pictures.observed import (
    CAMERAS,
    CORNERS,
    IN_HAND,
    LENS,
    NAME,
    SETUP,
    doubt_of,
)
from recalib.laboratory.tables.columns import NUMBER, read_table
from recalib.laboratory.tables.measurements import OBSERVED, PICTURE
from recalib.spelling import counted
from recalib.vision.boards import MOST, Board, read_board
from recalib.vision.detection import FEWEST, Corners, are_on_a_line
from recalib.vision.lens_search import FEWEST as FEWEST_VIEWS
from recalib.vision.lens_search import find_lens, moved_lens
from recalib.vision.lenses import Lens, read_lens
from recalib.vision.views import optics_kinds, optics_of, sighting

PIXEL = Quantity("a pixel", {"px": 1.0})
COLUMNS = {"corner": NUMBER, "u": PIXEL, "v": PIXEL}
MOST_CORNERS = 1_000_000
FARTHEST = 1e5  # px from the picture's corner


@dataclass(frozen=True)
class Session:
    """Pictures of a board by a camera.

    Attributes:
        folder: that observe wrote.
        camera, board_name: their names.
        in_hand: whether the camera is on the hand.
        fitted: whether the lens is estimated from the pictures.
        board, lens: that they show, and through which they were taken.
        views: the corners in each row's picture.
    """

    folder: Path
    camera: str
    board_name: str
    in_hand: bool
    fitted: bool
    board: Board
    lens: Lens
    views: list[Corners]


class Sighted(NamedTuple):
    """Observations by cameras.

    Attributes:
        observations: of all folders, in their order; each folder is a sight.
        instruments, targets: the names of what stands, and of what moves with the tool.
        sights: (s, 2) the numbers of each sight's instrument and target.
        boards: the names of boards.
        lenses: of each camera by its name, for which the optics are zero.
        columns: by camera, the numbers of the optics that are of its lens.
        doubts: of lenses, in sentences.
    """

    observations: Observations
    instruments: tuple[str, ...]
    targets: tuple[str, ...]
    sights: np.ndarray
    boards: tuple[str, ...]
    lenses: dict[str, Lens]
    columns: dict[str, np.ndarray]
    doubts: tuple[str, ...]


def with_pixels(rows: Sequence[Observations], folders: Sequence[Path]) -> Sighted:
    """Observations in folders, whose poses are those of their pixels.

    Raises InvalidFile: not as observe wrote it, or not of the same cameras and boards.
    """
    sessions, lenses, doubts = read_sessions(folders), dict[str, Lens](), list[str]()
    poses, parts = [], []
    for camera in dict.fromkeys(session.camera for session in sessions):
        same = [session for session in sessions if session.camera == camera]
        lenses[camera] = _lens_of(same, doubts)
    kinds, columns = _layout(sessions, lenses)
    for session, own in zip(sessions, columns, strict=True):
        board, lens = session.board, lenses[session.camera]
        ways = session.fitted, session.in_hand
        found, part = optics_of(
            lens, [sighting(board, lens, view, *ways) for view in session.views]
        )
        poses.append(found)
        parts.append(_placed(part, own, kinds))
    cameras, boards = _names("camera", sessions), _names("board", sessions)
    pairs = zip(cameras, boards, strict=True)
    ends = [
        pair[::-1] if session.in_hand else pair
        for session, pair in zip(sessions, pairs, strict=True)
    ]
    instruments, targets = (tuple(dict.fromkeys(names)) for names in zip(*ends, strict=True))
    spread, slopes, information, gradient, pixels = map(np.concatenate, zip(*parts, strict=True))
    times = [part.times for part in rows if part.times is not None]
    observations = Observations(
        np.concatenate([part.joints for part in rows]),
        np.concatenate(poses),
        np.repeat(np.arange(len(rows)), [len(part) for part in rows]),
        times=np.concatenate(times) if len(times) == len(rows) else None,
        optics=Optics(spread, slopes, information, gradient, pixels, kinds=kinds),
    )
    sights = [[instruments.index(one), targets.index(other)] for one, other in ends]
    return Sighted(
        observations,
        instruments,
        targets,
        np.array(sights),
        tuple(dict.fromkeys(boards)),
        lenses,
        {session.camera: own[len(BOARD) :] for session, own in zip(sessions, columns, strict=True)},
        tuple(doubts),
    )


def read_sessions(folders: Sequence[Path]) -> list[Session]:
    """What folders show. Raises as `with_pixels`."""
    sessions: list[Session] = []
    for folder in folders:
        session = _session(folder)
        for before in sessions:
            if conflict := _conflict(before, session):
                raise InvalidFile(folder, conflict)
        sessions.append(session)
    return sessions


def _lens_of(sessions: Sequence[Session], doubts: list[str]) -> Lens:
    """The lens of a camera, by the pictures of its sessions or as given; adds what is doubtful."""
    views = [(session.board, view) for session in sessions for view in session.views]
    given, fitted = sessions[0].lens, sessions[0].fitted
    if len(views) < FEWEST_VIEWS:
        return given
    found = find_lens(views, given.size)
    if doubt := doubt_of(None if fitted else given, found, views):
        doubts.append(doubt)
    return found.lens if fitted else given


def fitted_lenses(sighted: Sighted, optics: np.ndarray) -> dict[str, Lens]:
    """By camera, the lens with what a calibration found of the optics (o,)."""
    found = {}
    for camera, lens in sighted.lenses.items():
        columns = sighted.columns[camera]
        found[camera] = (moved_lens(lens, optics[columns]) if len(columns) else None) or lens
    return found


def _session(folder: Path) -> Session:
    board, text = read_board(folder / SETUP), read_file(folder / SETUP, MOST)
    setup = tomllib.loads(text.decode("utf-8"))
    camera, fitted = setup.get("camera"), setup.get("lens_from_pictures")
    if camera not in CAMERAS or not isinstance(fitted, bool):
        raise InvalidFile(folder / SETUP, "camera or lens_from_pictures is not as observe wrote it")
    names: list[Any] = [setup.get(f"{kind}_name") for kind in ("camera", "board")]
    if not all(isinstance(name, str) and NAME.fullmatch(name) for name in names):
        raise InvalidFile(folder / SETUP, "camera_name or board_name is not as observe wrote it")
    lens, views = read_lens(folder / LENS), _views(folder, board)
    return Session(folder, names[0], names[1], camera == IN_HAND, fitted, board, lens, views)


def _conflict(one: Session, other: Session) -> str | None:
    """Why two folders cannot be of one cell, if they cannot."""
    camera, board = one.camera == other.camera, one.board_name == other.board_name
    if camera and board:
        return (
            f"it is of camera {one.camera!r} and board {one.board_name!r}, as {one.folder} is; try:"
            " observe with another --name, or all of their pictures in one folder"
        )
    sides = {True: "on the hand", False: "beside the arm"}
    if camera and one.in_hand != other.in_hand:
        return (
            f"it has camera {one.camera!r} {sides[other.in_hand]}, {one.folder} has it"
            f" {sides[one.in_hand]}; try: observe with another --name"
        )
    if board and (one.in_hand != other.in_hand or one.board != other.board):
        return (
            f"its board {one.board_name!r} is another one than that of {one.folder}; try: observe"
            " with a --board of another file name"
        )
    lenses = [
        (session.fitted, session.lens.size if session.fitted else session.lens.as_ros())
        for session in (one, other)
    ]
    if camera and lenses[0] != lenses[1]:
        return f"camera {one.camera!r} has another lens than in {one.folder}; try: the same --lens"
    return None


def _names(kind: str, sessions: Sequence[Session]) -> list[str]:
    """What each session's camera or board is called, in words."""
    names = [session.camera if kind == "camera" else session.board_name for session in sessions]
    return [f"{kind} {name}" if len(set(names)) > 1 else f"the {kind}" for name in names]


def _layout(
    sessions: Sequence[Session], lenses: Mapping[str, Lens]
) -> tuple[np.ndarray, list[np.ndarray]]:
    """The kinds (o,) of all optics, and the numbers of those that each session has."""
    boards = [*dict.fromkeys(session.board_name for session in sessions)]
    parts, starts = [np.arange(len(BOARD)) for _ in boards], {}
    for session in sessions:
        if session.fitted and session.camera not in starts:
            starts[session.camera] = sum(map(len, parts))
            parts.append(optics_kinds(lenses[session.camera]))
    columns = []
    for session in sessions:
        own = len(BOARD) * boards.index(session.board_name) + np.arange(len(BOARD))
        if session.fitted:
            count = len(optics_kinds(lenses[session.camera]))
            own = np.concatenate([own, starts[session.camera] + np.arange(count)])
        columns.append(own)
    return np.concatenate(parts), columns


def _placed(part: Optics, own: np.ndarray, kinds: np.ndarray) -> tuple[np.ndarray, ...]:
    """The arrays of a session's optics, up to its pixels, with its columns among those of all."""
    count, size = len(part.slopes), len(kinds)
    slopes, gradient = np.zeros((count, 6, size)), np.zeros((count, size))
    information = np.zeros((count, size, size))
    slopes[..., own], gradient[:, own] = part.slopes, part.gradient
    information[:, own[:, None], own] = part.information
    return part.spread, slopes, information, gradient, part.pixels


def _views(folder: Path, board: Board) -> list[Corners]:
    """The corners in each row's picture: rows may have been taken out or moved."""
    rows = read_table(folder / OBSERVED)
    table = read_table(folder / CORNERS, most=MOST_CORNERS)
    for read, columns in ((rows, [PICTURE]), (table, [PICTURE, *COLUMNS])):
        if missing := [column for column in columns if column not in read]:
            raise InvalidFile(read.path, f"column {missing[0]!r} is missing")
    pictures, points = np.array(table.cells[PICTURE]), len(board.points)
    corner, u, v = (table.numbers(column, kind) for column, kind in COLUMNS.items())
    if not np.isin(corner, np.arange(points)).all():
        raise InvalidFile(table.path, f"a corner is not among the board's {points}")
    if max(np.abs(u).max(), np.abs(v).max()) > FARTHEST:
        raise InvalidFile(
            table.path, f"a corner is more than {FARTHEST:g} px off; expected: pixels"
        )
    pixels, views = np.stack([u, v], axis=1), []
    for picture in rows.cells[PICTURE]:
        own = pictures == picture
        numbers = corner[own].astype(int)
        if len(numbers) < FEWEST:
            raise InvalidFile(table.path, f"{picture} has {counted(len(numbers), 'corner')}")
        if len(np.unique(numbers)) < len(numbers):
            raise InvalidFile(table.path, f"{picture} has a corner more than once")
        if are_on_a_line(board, numbers):
            raise InvalidFile(table.path, f"all corners in {picture} lie on a line")
        views.append(Corners(numbers, pixels[own], 0.0))
    return views
