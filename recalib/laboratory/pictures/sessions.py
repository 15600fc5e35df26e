"""A data set from folders that `observe` wrote: poses, and the information of pixels on optics.

Each folder holds one session: one camera, one board. Folders may share a camera or a board.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from recalib.errors import InvalidFile, InvalidSetting, check_function
from recalib.files.outputs import AnyPath
from recalib.files.quantities import NUMBER, Quantity
from recalib.files.storage import path_of, read_toml
from recalib.identification.model.observations import Observations
from recalib.identification.model.optics import BOARD, Optics
from recalib.laboratory.calibrate import Calibrated, Progress, identified, opened
from recalib.laboratory.data_set import DataSet
from recalib.laboratory.options import CAMERAS, IN_HAND
from recalib.laboratory.pictures.observed import CORNERS, LENS, NAME, OBSERVED, SETUP, doubt_of
from recalib.laboratory.tables.columns import PICTURE, PICTURES, TEXT, TIMES, Columns
from recalib.laboratory.tables.description import Description
from recalib.laboratory.tables.measurements import Measurements, read_joints
from recalib.laboratory.tables.table import read_table
from recalib.nominal.kinematics import Arm
from recalib.spelling import counted
from recalib.vision.boards import FEWEST, Board, board_in
from recalib.vision.detection import Corners, are_on_a_line
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
FLAT = 1e-3  # width of the corners in a picture over their length: less is a line
SMALLEST, BENT = 3.0, 0.3  # RMS size of a board [px]; largest shift by distortion, as its fraction


@dataclass(frozen=True)
class Session:
    """Pictures of a board by a camera."""

    folder: Path  # written by observe
    camera: str
    board_name: str
    in_hand: bool  # whether the camera is on the hand
    fitted: bool  # whether the lens is estimated from the pictures
    board: Board  # in all pictures
    lens: Lens  # of all pictures
    rows: Measurements
    views: list[Corners]  # the corners in each row's picture

    @classmethod
    def read(cls, folder: Path, arm: Arm) -> "Session":
        """Read a session from a folder; its table must fit the arm. Raises InvalidFile."""
        setup = read_toml(path := folder / SETUP)
        camera, fitted = setup.get("camera"), setup.get("lens_from_pictures")
        if camera not in CAMERAS or not isinstance(fitted, bool):
            raise InvalidFile(path, "camera or lens_from_pictures is not as observe wrote it")
        names: list[Any] = [setup.get(f"{kind}_name") for kind in ("camera", "board")]
        if not all(isinstance(name, str) and NAME.fullmatch(name) for name in names):
            raise InvalidFile(path, "camera_name or board_name is not as observe wrote it")
        board, lens = board_in(setup, path), read_lens(folder / LENS)
        rows = read_joints(folder / OBSERVED, arm)
        views = _views(folder / CORNERS, rows, board, lens.size)
        return cls(folder, names[0], names[1], camera == IN_HAND, fitted, board, lens, rows, views)

    def conflict(self, other: "Session") -> str | None:
        """Why another session contradicts this one; None if both can be in the same cell."""
        camera, board = self.camera == other.camera, self.board_name == other.board_name
        if camera and board:
            return (
                f"it has camera {self.camera!r} and board {self.board_name!r}, as {self.folder}"
                " has; try: observe with another --name, or all of their pictures in one folder"
            )
        sides = {True: "on the hand", False: "next to the arm"}
        if camera and self.in_hand != other.in_hand:
            return (
                f"it has camera {self.camera!r} {sides[other.in_hand]}, {self.folder} has it"
                f" {sides[self.in_hand]}; try: observe with another --name"
            )
        if board and (self.in_hand != other.in_hand or self.board != other.board):
            return (
                f"its board {self.board_name!r} differs from that in {self.folder}; try: observe"
                " with a --board of another file name"
            )
        lenses = [
            (session.fitted, session.lens.size if session.fitted else session.lens.as_ros())
            for session in (self, other)
        ]
        if camera and lenses[0] != lenses[1]:
            found = f"camera {self.camera!r} has another lens than in {self.folder}"
            return f"{found}; try: the same --lens"
        return None


def calibrate_pictures(
    urdf: AnyPath,
    folders: Sequence[AnyPath],
    description: AnyPath | Description | None = None,
    tool: str | None = None,
    base: str | None = None,
    on_progress: Progress = lambda line: None,
) -> Calibrated:
    """Identify the errors of an arm from folders that `recalib observe` wrote.

    Args:
        folders: one for each camera and board.
        urdf, description, tool, base, on_progress: see `calibrate_arm`.

    Raises RecalibError like `calibrate_arm`.
    """
    if isinstance(folders, str) or not isinstance(folders, Sequence) or not folders:
        raise InvalidSetting("folders", folders, "a list of at least one folder")
    check_function("on_progress", on_progress)
    file, arm, known = opened(urdf, description, tool, base)
    on_progress(file.origin)
    if len(folders) > 1 and (known.instrument is not None or known.target is not None):
        reason = "the description has an instrument or a target, which is for one camera"
        raise InvalidFile(folders[1], f"{reason}; try: omit it")
    return identified(arm, read_folders([*map(path_of, folders)], arm, known), file, on_progress)


def read_folders(folders: Sequence[Path], arm: Arm, known: Description) -> DataSet:
    """The data set of an arm from folders.

    Raises InvalidFile: a folder that is not as observe wrote it, or contradictory folders.
    """
    sessions = [Session.read(folder, arm) for folder in folders]
    for before, session in combinations(sessions, 2):
        if conflict := before.conflict(session):
            raise InvalidFile(session.folder, conflict)
    lenses, doubts = {}, []  # these lenses correspond to optics of zero
    for camera in dict.fromkeys(session.camera for session in sessions):
        lenses[camera], doubt = _lens_of([one for one in sessions if one.camera == camera])
        doubts += [doubt] if doubt else []
    # columns of optics: first those of each board, then those of each estimated lens
    parts = {("board", one.board_name): np.arange(len(BOARD)) for one in sessions}
    fitted = [one.camera for one in sessions if one.fitted]
    parts |= {("camera", name): optics_kinds(lenses[name]) for name in fitted}
    kinds, sizes = np.concatenate([*parts.values()]), [len(part) for part in parts.values()]
    numbers = dict(zip(parts, np.split(np.arange(len(kinds)), np.cumsum(sizes)[:-1]), strict=True))

    def lens_files(optics: np.ndarray) -> dict[str, bytes]:
        """Files of the lenses with corrections (o,), by file name."""
        files = {}
        for camera, lens in lenses.items():
            columns = numbers.get(("camera", camera))
            moved = None if columns is None else moved_lens(lens, optics[columns])
            name = LENS if len(lenses) == 1 else f"lens_{camera}.yaml"
            files[name] = (moved or lens).as_ros().encode()
        return files

    poses, arrays = [], []
    for session in sessions:
        lens, kind = lenses[session.camera], (session.fitted, session.in_hand)
        views = [sighting(session.board, lens, view, *kind) for view in session.views]
        found, part = optics_of(lens, views)
        columns = [numbers["board", session.board_name]]
        if session.fitted:
            columns.append(numbers["camera", session.camera])
        embed = np.eye(len(kinds))[np.concatenate(columns)]  # this session's columns among all
        slopes, gradient = part.slopes @ embed, part.gradient @ embed
        poses.append(found)
        arrays.append(
            (part.spread, slopes, embed.T @ part.information @ embed, gradient, part.pixels)
        )
    cameras = _in_words("camera", [session.camera for session in sessions])
    boards = _in_words("board", [session.board_name for session in sessions])
    ends = [
        (board, camera) if session.in_hand else (camera, board)
        for session, camera, board in zip(sessions, cameras, boards, strict=True)
    ]
    instruments, targets = (tuple(dict.fromkeys(names)) for names in zip(*ends, strict=True))
    spread, slopes, information, gradient, pixels = map(np.concatenate, zip(*arrays, strict=True))
    tables = [session.rows for session in sessions]
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
    return DataSet(
        observations,
        targets,
        instruments=instruments,
        known=known,
        sights=np.array([[instruments.index(one), targets.index(other)] for one, other in ends]),
        tables=tuple(rows.path for rows in tables),
        boards=tuple(dict.fromkeys(boards)),
        doubts=doubts,
        lens_files=lens_files,
    )


def _lens_of(sessions: Sequence[Session]) -> tuple[Lens, str | None]:
    """The lens of a camera, estimated from its sessions or as given, and a warning about it."""
    views = [(session.board, view) for session in sessions for view in session.views]
    given, fitted = sessions[0].lens, sessions[0].fitted
    if len(views) < FEWEST_VIEWS:
        return given, None
    found = find_lens(views, given.size)
    return found.lens if fitted else given, doubt_of(None if fitted else given, found, views)


def _in_words(kind: str, names: Sequence[str]) -> list[str]:
    """Names of cameras or boards for a sentence."""
    return [f"{kind} {name}" if len(set(names)) > 1 else f"the {kind}" for name in names]


def _views(path: Path, rows: Measurements, board: Board, size: tuple[int, int]) -> list[Corners]:
    """The corners in each row's picture; the user may have removed or reordered rows.

    Raises InvalidFile if no picture of the board can have these corners.
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
        if (outside := ((pixels < -1) | (pixels > size)).any(axis=1)).any():
            u, v = pixels[outside][0]
            found = f"corner {numbers[outside][0]} of {picture} is at ({u:.6g}, {v:.6g}) px"
            raise InvalidFile(path, f"{found}; expected: inside {size[0]} x {size[1]} px")
        widths = np.linalg.svd(pixels - pixels.mean(axis=0), compute_uv=False)
        if are_on_a_line(board, numbers) or widths[1] <= FLAT * widths[0]:
            raise InvalidFile(path, f"all corners of {picture} are on a line")
        if not _are_of(points[numbers], pixels):
            found = f"corners of {picture} are not where a board of squares can have them"
            raise InvalidFile(path, f"{found}; try: remove its row")
        views.append(Corners(numbers, pixels, 0.0))
    return views


def _are_of(points: np.ndarray, pixels: np.ndarray) -> bool:
    """Whether pixels (c, 2) can show points (c, 3) of a board, for any lens.

    A homography must fit them up to the lens's distortion, with the board facing the camera.
    """
    size = np.sqrt(np.mean(np.sum((pixels - pixels.mean(axis=0)) ** 2, axis=1)))
    homography, _ = cv2.findHomography(points[:, :2], pixels) if size > SMALLEST else (None, None)
    if homography is None:
        return False
    there = cv2.perspectiveTransform(points[:, None, :2], homography)[:, 0]
    weights = points[:, :2] @ homography[2, :2] + homography[2, 2]
    off = np.linalg.norm(pixels - there, axis=1).max()
    return bool(off < BENT * size and np.linalg.det(homography) > 0 and (weights > 0).all())
