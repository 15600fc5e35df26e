"""What `observe` wrote, as observations of an arm: poses and what its pixels make of them.

Each folder has pictures of one board by one camera. Folders may share a camera, or a board.
"""

import tomllib
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from recalib.errors import InvalidFile
from recalib.files.quantities import Quantity
from recalib.files.storage import read_file
from recalib.identification.model.observations import Observations
from recalib.identification.model.optics import BOARD, OPTICS, Optics
from recalib.laboratory.pictures.observe import CAMERAS, CORNERS, IN_HAND, LENS, NAME, SETUP
from recalib.laboratory.tables.columns import NUMBER, read_table
from recalib.laboratory.tables.measurements import OBSERVED, PICTURE
from recalib.spelling import counted
from recalib.vision.boards import MOST, Board, read_board
from recalib.vision.detection import FEWEST, Corners
from recalib.vision.lenses import Lens, read_lens
from recalib.vision.views import LENS_SIZE, optics_of, sighting

PIXEL = Quantity("a pixel", {"px": 1.0})
COLUMNS = {"corner": NUMBER, "u": PIXEL, "v": PIXEL}
MOST_CORNERS = 1_000_000


@dataclass(frozen=True)
class Session:
    """Pictures of a board by a camera.

    Attributes:
        folder: that observe wrote.
        camera, board_name: their names.
        in_hand: whether the camera is on the hand.
        fitted: whether the lens is that of the pictures.
        board, lens: that they show, and through which they were taken.
    """

    folder: Path
    camera: str
    board_name: str
    in_hand: bool
    fitted: bool
    board: Board
    lens: Lens


class Sighted(NamedTuple):
    """Observations by cameras.

    Attributes:
        observations: of all folders, in their order; each folder is a sight.
        instruments, targets: the names of what stands, and of what moves with the tool.
        sights: (s, 2) the numbers of each sight's instrument and target.
        boards: the names of boards.
    """

    observations: Observations
    instruments: tuple[str, ...]
    targets: tuple[str, ...]
    sights: np.ndarray
    boards: tuple[str, ...]


def with_pixels(rows: Sequence[Observations], folders: Sequence[Path]) -> Sighted:
    """Observations in folders, whose poses are those of their pixels.

    Raises InvalidFile: not as observe wrote it, or not of the same cameras and boards.
    """
    sessions, poses, parts = read_sessions(folders), [], []
    kinds, columns = _layout(sessions)
    for session, own in zip(sessions, columns, strict=True):
        board, lens, *kind = session.board, session.lens, session.fitted, session.in_hand
        found, part = optics_of([sighting(board, lens, view, *kind) for view in _views(session)])
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
    times = [its.times for its in rows if its.times is not None]
    observations = Observations(
        np.concatenate([its.joints for its in rows]),
        np.concatenate(poses),
        np.repeat(np.arange(len(rows)), [len(its) for its in rows]),
        times=np.concatenate(times) if len(times) == len(rows) else None,
        optics=Optics(spread, slopes, information, gradient, pixels, kinds=kinds),
    )
    sights = [[instruments.index(one), targets.index(other)] for one, other in ends]
    several = tuple(dict.fromkeys(boards))
    return Sighted(observations, instruments, targets, np.array(sights), several)


def read_sessions(folders: Sequence[Path]) -> list[Session]:
    """What folders show; a camera has the lens of its first one. Raises as `with_pixels`."""
    sessions: list[Session] = []
    for folder in folders:
        session = _session(folder)
        for before in sessions:
            if conflict := _conflict(before, session):
                raise InvalidFile(folder, conflict)
        same = (before.lens for before in sessions if before.camera == session.camera)
        sessions.append(replace(session, lens=next(same, session.lens)))
    return sessions


def fitted_lenses(folders: Sequence[Path], optics: np.ndarray) -> dict[str, Lens]:
    """By camera, the lens in folders with what a calibration found of the optics (o,) beside it."""
    sessions, lenses = read_sessions(folders), {}
    for session, own in zip(sessions, _layout(sessions)[1], strict=True):
        beside = np.zeros(len(OPTICS))
        beside[: len(own)] = optics[own]
        fx, fy, cx, cy, *distortion = beside[len(BOARD) :]
        lens = session.lens
        matrix, changed = lens.matrix.copy(), lens.distortion.copy()
        matrix[:2] += np.array([[fx, 0, cx], [0, fy, cy]])
        changed[:4] += distortion
        lenses[session.camera] = Lens(lens.size, matrix, changed)
    return lenses


def _session(folder: Path) -> Session:
    board, text = read_board(folder / SETUP), read_file(folder / SETUP, MOST)
    setup = tomllib.loads(text.decode("utf-8"))
    camera, fitted = setup.get("camera"), setup.get("lens_from_pictures")
    if camera not in CAMERAS or not isinstance(fitted, bool):
        raise InvalidFile(folder / SETUP, "camera or lens_from_pictures is not as observe wrote it")
    names: list[Any] = [setup.get(f"{kind}_name") for kind in ("camera", "board")]
    if not all(isinstance(name, str) and NAME.fullmatch(name) for name in names):
        raise InvalidFile(folder / SETUP, "camera_name or board_name is not as observe wrote it")
    name, its = names
    return Session(folder, name, its, camera == IN_HAND, fitted, board, read_lens(folder / LENS))


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
        (its.fitted, its.lens.size if its.fitted else its.lens.as_ros()) for its in (one, other)
    ]
    if camera and lenses[0] != lenses[1]:
        return f"camera {one.camera!r} has another lens than in {one.folder}; try: the same --lens"
    return None


def _names(kind: str, sessions: Sequence[Session]) -> list[str]:
    """What each session's camera or board is called, in words."""
    names = [its.camera if kind == "camera" else its.board_name for its in sessions]
    return [f"{kind} {name}" if len(set(names)) > 1 else f"the {kind}" for name in names]


def _layout(sessions: Sequence[Session]) -> tuple[np.ndarray, list[np.ndarray]]:
    """The kinds (o,) of all optics, and the numbers of those that each session has."""
    boards = [*dict.fromkeys(its.board_name for its in sessions)]
    lenses = [*dict.fromkeys(its.camera for its in sessions if its.fitted)]
    board, lens = np.arange(len(BOARD)), np.arange(LENS_SIZE)
    kinds = np.concatenate([board] * len(boards) + [len(BOARD) + lens] * len(lenses))
    columns = []
    for its in sessions:
        own = [len(BOARD) * boards.index(its.board_name) + board]
        if its.fitted:
            own.append(len(BOARD) * len(boards) + LENS_SIZE * lenses.index(its.camera) + lens)
        columns.append(np.concatenate(own))
    return kinds, columns


def _placed(part: Optics, own: np.ndarray, kinds: np.ndarray) -> tuple[np.ndarray, ...]:
    """The arrays of a session's optics, up to its pixels, with its columns among those of all."""
    count, size = len(part.slopes), len(kinds)
    slopes, gradient = np.zeros((count, 6, size)), np.zeros((count, size))
    information = np.zeros((count, size, size))
    slopes[..., own], gradient[:, own] = part.slopes, part.gradient
    information[:, own[:, None], own] = part.information
    return part.spread, slopes, information, gradient, part.pixels


def _views(session: Session) -> list[Corners]:
    """The corners in each row's picture: rows may have been taken out or moved."""
    rows = read_table(session.folder / OBSERVED)
    table = read_table(session.folder / CORNERS, most=MOST_CORNERS)
    for its, columns in ((rows, [PICTURE]), (table, [PICTURE, *COLUMNS])):
        if missing := [column for column in columns if column not in its]:
            raise InvalidFile(its.path, f"column {missing[0]!r} is missing")
    pictures, points = np.array(table.cells[PICTURE]), len(session.board.points)
    corner, u, v = (table.numbers(column, kind) for column, kind in COLUMNS.items())
    if not np.isin(corner, np.arange(points)).all():
        raise InvalidFile(table.path, f"a corner is not among the board's {points}")
    pixels, views = np.stack([u, v], axis=1), []
    for picture in rows.cells[PICTURE]:
        its = pictures == picture
        if its.sum() < FEWEST:
            raise InvalidFile(table.path, f"{picture} has {counted(its.sum(), 'corner')}")
        views.append(Corners(corner[its].astype(int), pixels[its], 0.0))
    return views
