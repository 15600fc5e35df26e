"""Folders that `observe` wrote, as a data set: poses and what their pixels say of the optics.

Each folder has pictures of one board by one camera. Folders may share a camera, or a board.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from recalib.errors import InvalidFile
from recalib.files.quantities import NUMBER, Quantity
from recalib.files.toml import read_toml
from recalib.identification.model.observations import Observations
from recalib.identification.model.optics import BOARD, Optics
from recalib.laboratory.calibrate import Calibrated, identified, opened, silent
from recalib.laboratory.data_set import DataSet
from recalib.laboratory.pictures.observed import (
    CAMERAS,
    CORNERS,
    IN_HAND,
    LENS,
    NAME,
    OBSERVED,
    PICTURE,
    SETUP,
    doubt_of,
)
from recalib.laboratory.tables.columns import PICTURES, TEXT, TIMES, Columns
from recalib.laboratory.tables.description import Description
from recalib.laboratory.tables.measurements import Measurements, read_joints
from recalib.laboratory.tables.table import read_table
from recalib.nominal.kinematics import Arm
from recalib.spelling import counted
from recalib.vision.boards import Board, board_in
from recalib.vision.detection import FEWEST, Corners, are_on_a_line
from recalib.vision.lens_search import FEWEST as FEWEST_VIEWS
from recalib.vision.lens_search import find_lens, moved_lens
from recalib.vision.lenses import Lens, read_lens
from recalib.vision.views import optics_kinds, optics_of, sighting

PIXEL = Quantity("a pixel", {"px": 1.0}, farthest=1e5)
LAYOUT = (
    Columns("pictures", (PICTURE,), TEXT, needed=True),
    Columns("corners", ("corner",), NUMBER, needed=True),
    Columns("pixels", ("u", "v"), PIXEL, needed=True),
)
MOST_CORNERS = 1_000_000
FLAT = 1e-3  # the width of corners in a picture over their length: less is a line


@dataclass(frozen=True)
class Session:
    """Pictures of a board by a camera.

    Attributes:
        folder: that observe wrote.
        camera, board_name: their names.
        in_hand: whether the camera is on the hand.
        fitted: whether the lens is estimated from the pictures.
        board, lens: in all pictures.
        rows: of the table.
        views: the corners in each row's picture.
    """

    folder: Path
    camera: str
    board_name: str
    in_hand: bool
    fitted: bool
    board: Board
    lens: Lens
    rows: Measurements
    views: list[Corners]


@dataclass(frozen=True)
class Cell:
    """The cameras and boards of several sessions, and their optics as parameters.

    Attributes:
        sessions: each is a sight.
        lenses: by camera, its lens as given or by the pictures of all its sessions: that for which
            the optics are zero.
        doubts: see `recalib.laboratory.data_set.Cameras`.
    """

    sessions: Sequence[Session]
    lenses: Mapping[str, Lens]
    doubts: Sequence[str]

    @classmethod
    def read(cls, folders: Sequence[Path], arm: Arm) -> "Cell":
        """The cell in folders, whose tables have the joints of an arm.

        Raises InvalidFile: not as observe wrote it, or not of the same cameras and boards.
        """
        sessions: list[Session] = []
        for folder in folders:
            session = _session(folder, arm)
            for before in sessions:
                if conflict := _conflict(before, session):
                    raise InvalidFile(folder, conflict)
            sessions.append(session)
        lenses, doubts = {}, []
        for camera in dict.fromkeys(session.camera for session in sessions):
            lenses[camera], doubt = _lens_of([one for one in sessions if one.camera == camera])
            doubts += [doubt] if doubt else []
        return cls(sessions, lenses, doubts)

    @property
    def cameras(self) -> list[str]:
        """The name of each session's camera, in words."""
        return _in_words("camera", [session.camera for session in self.sessions])

    @property
    def boards(self) -> list[str]:
        """The name of each session's board, in words."""
        return _in_words("board", [session.board_name for session in self.sessions])

    @property
    def kinds(self) -> np.ndarray:
        """The kinds (o,) of all optics: those of each board, then those of each fitted lens."""
        boards = [np.arange(len(BOARD))] * len({*self.boards})
        return np.concatenate([*boards, *self._fitted.values()])

    @property
    def columns(self) -> list[np.ndarray]:
        """The numbers of the optics of each session."""
        boards, lenses = [*dict.fromkeys(self.boards)], {}
        start = len(BOARD) * len(boards)
        for camera, kinds in self._fitted.items():
            lenses[camera] = start + np.arange(len(kinds))
            start += len(kinds)
        return [
            np.concatenate(
                [
                    len(BOARD) * boards.index(board) + np.arange(len(BOARD)),
                    lenses.get(session.camera, np.zeros(0, int)),
                ]
            )
            for session, board in zip(self.sessions, self.boards, strict=True)
        ]

    @property
    def _fitted(self) -> dict[str, np.ndarray]:
        """By camera, the kinds of optics of its lens; of those estimated from pictures."""
        cameras = dict.fromkeys(session.camera for session in self.sessions if session.fitted)
        return {camera: optics_kinds(self.lenses[camera]) for camera in cameras}

    def corrected_lenses(self, optics: np.ndarray) -> dict[str, Lens]:
        """By camera, its lens with the corrections (o,) of a calibration."""
        lenses = dict(self.lenses)
        for session, own in zip(self.sessions, self.columns, strict=True):
            if session.fitted:
                lens = self.lenses[session.camera]
                lenses[session.camera] = moved_lens(lens, optics[own[len(BOARD) :]]) or lens
        return lenses

    def lens_files(self, optics: np.ndarray) -> dict[str, bytes]:
        """See `recalib.laboratory.data_set.Cameras`."""
        lenses = self.corrected_lenses(optics)
        return {
            LENS if len(lenses) == 1 else f"lens_{camera}.yaml": lens.as_ros().encode()
            for camera, lens in lenses.items()
        }


def calibrate_pictures(
    urdf: str | PathLike[str],
    folders: Sequence[str | PathLike[str]],
    description: str | PathLike[str] | Description | None = None,
    tool: str | None = None,
    base: str | None = None,
    on_progress: Callable[[str], None] = silent,
) -> Calibrated:
    """Identify the errors of an arm from folders that `recalib observe` wrote.

    Args:
        folders: one for each camera and board.
        urdf, description, tool, base, on_progress: see `calibrate_arm`.

    Raises RecalibError, as `calibrate_arm`.
    """
    file, arm, known = opened(urdf, description, tool, base, on_progress)
    if len(folders) > 1 and (known.instrument is not None or known.target is not None):
        reason = "the description has an instrument or a target, which is for one camera"
        raise InvalidFile(folders[1], f"{reason}; try: without")
    return identified(arm, read_folders([*map(Path, folders)], arm, known), file, on_progress)


def read_folders(folders: Sequence[Path], arm: Arm, known: Description) -> DataSet:
    """What the pixels in folders say of an arm. Raises InvalidFile, as `Cell.read`."""
    cell, poses, parts = Cell.read(folders, arm), [], []
    kinds, tables = cell.kinds, [session.rows for session in cell.sessions]
    for session, own in zip(cell.sessions, cell.columns, strict=True):
        board, lens = session.board, cell.lenses[session.camera]
        kind = session.fitted, session.in_hand
        found, part = optics_of(
            lens, [sighting(board, lens, view, *kind) for view in session.views]
        )
        poses.append(found)
        parts.append(_placed(part, own, kinds))
    pairs = zip(cell.cameras, cell.boards, strict=True)
    ends = [
        pair[::-1] if session.in_hand else pair
        for session, pair in zip(cell.sessions, pairs, strict=True)
    ]
    instruments, targets = (tuple(dict.fromkeys(names)) for names in zip(*ends, strict=True))
    spread, slopes, information, gradient, pixels = map(np.concatenate, zip(*parts, strict=True))
    times = [rows.columns[TIMES.name] for rows in tables if TIMES.name in rows.columns]
    observations = Observations(
        arm.coupling.joints(
            np.concatenate([rows.joints for rows in tables if rows.joints is not None])
        ),
        np.concatenate(poses),
        np.repeat(np.arange(len(tables)), [len(rows) for rows in tables]),
        times=np.concatenate(times) if len(times) == len(tables) else None,
        optics=Optics(spread, slopes, information, gradient, pixels, kinds=kinds),
    )
    sights = [[instruments.index(one), targets.index(other)] for one, other in ends]
    return DataSet(
        observations,
        targets,
        instruments=instruments,
        known=known,
        sights=np.array(sights),
        tables=tuple(rows.path for rows in tables),
        boards=tuple(dict.fromkeys(cell.boards)),
        cameras=cell,
    )


def _session(folder: Path, arm: Arm) -> Session:
    setup = read_toml(path := folder / SETUP)
    camera, fitted = setup.get("camera"), setup.get("lens_from_pictures")
    if camera not in CAMERAS or not isinstance(fitted, bool):
        raise InvalidFile(path, "camera or lens_from_pictures is not as observe wrote it")
    names: list[Any] = [setup.get(f"{kind}_name") for kind in ("camera", "board")]
    if not all(isinstance(name, str) and NAME.fullmatch(name) for name in names):
        raise InvalidFile(path, "camera_name or board_name is not as observe wrote it")
    board, lens = board_in(setup, path), read_lens(folder / LENS)
    rows = read_joints(folder / OBSERVED, arm)
    views = _views(folder / CORNERS, rows, board)
    return Session(folder, names[0], names[1], camera == IN_HAND, fitted, board, lens, rows, views)


def _lens_of(sessions: Sequence[Session]) -> tuple[Lens, str | None]:
    """The lens of a camera, by the pictures of its sessions or as given, and what is doubtful."""
    views = [(session.board, view) for session in sessions for view in session.views]
    given, fitted = sessions[0].lens, sessions[0].fitted
    if len(views) < FEWEST_VIEWS:
        return given, None
    found = find_lens(views, given.size)
    return found.lens if fitted else given, doubt_of(None if fitted else given, found, views)


def _conflict(one: Session, other: Session) -> str | None:
    """Why two sessions cannot be in one cell, if they cannot."""
    camera, board = one.camera == other.camera, one.board_name == other.board_name
    if camera and board:
        return (
            f"it has camera {one.camera!r} and board {one.board_name!r}, as {one.folder} has; try:"
            " observe with another --name, or all of their pictures in one folder"
        )
    sides = {True: "on the hand", False: "next to the arm"}
    if camera and one.in_hand != other.in_hand:
        return (
            f"it has camera {one.camera!r} {sides[other.in_hand]}, {one.folder} has it"
            f" {sides[one.in_hand]}; try: observe with another --name"
        )
    if board and (one.in_hand != other.in_hand or one.board != other.board):
        return (
            f"its board {one.board_name!r} differs from that in {one.folder}; try: observe with a"
            " --board of another file name"
        )
    lenses = [
        (session.fitted, session.lens.size if session.fitted else session.lens.as_ros())
        for session in (one, other)
    ]
    if camera and lenses[0] != lenses[1]:
        return f"camera {one.camera!r} has another lens than in {one.folder}; try: the same --lens"
    return None


def _in_words(kind: str, names: Sequence[str]) -> list[str]:
    """Names of cameras or boards in a sentence."""
    return [f"{kind} {name}" if len(set(names)) > 1 else f"the {kind}" for name in names]


def _placed(part: Optics, own: np.ndarray, kinds: np.ndarray) -> tuple[np.ndarray, ...]:
    """The arrays of a session's optics, with its columns among those of the cell."""
    count, size = len(part.slopes), len(kinds)
    slopes, gradient = np.zeros((count, 6, size)), np.zeros((count, size))
    information = np.zeros((count, size, size))
    slopes[..., own], gradient[:, own] = part.slopes, part.gradient
    information[:, own[:, None], own] = part.information
    return part.spread, slopes, information, gradient, part.pixels


def _views(path: Path, rows: Measurements, board: Board) -> list[Corners]:
    """The corners in each row's picture: rows may have been taken out or moved.

    Raises InvalidFile: corners that no picture of the board can have.
    """
    if PICTURES.name not in rows.columns:
        raise InvalidFile(rows.path, f"column {PICTURE!r} is missing")
    table = read_table(path, most=MOST_CORNERS).read(LAYOUT)
    corners, points = table["corners"], board.points
    if not np.isin(corners, np.arange(len(points))).all():
        raise InvalidFile(path, f"a corner is not among the board's {len(points)}")
    views = []
    for picture in rows.columns[PICTURES.name]:
        shown = table["pictures"] == picture
        numbers, pixels = corners[shown].astype(int), table["pixels"][shown]
        if len(numbers) < FEWEST:
            raise InvalidFile(path, f"{picture} has {counted(len(numbers), 'corner')}")
        if len(np.unique(numbers)) < len(numbers):
            raise InvalidFile(path, f"{picture} has a corner twice")
        widths = np.linalg.svd(pixels - pixels.mean(axis=0), compute_uv=False)
        if are_on_a_line(board, numbers) or widths[1] <= FLAT * widths[0]:
            raise InvalidFile(path, f"all corners of {picture} are on a line")
        views.append(Corners(numbers, pixels, 0.0))
    return views
