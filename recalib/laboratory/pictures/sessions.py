"""Folders that `observe` wrote, as a data set: poses and what their pixels say of the optics.

Each folder has pictures of one board by one camera. Folders may share a camera, or a board.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

import numpy as np

from recalib.errors import InvalidFile
from recalib.identification.model.observations import Observations
from recalib.identification.model.optics import BOARD, Optics
from recalib.laboratory.calibrate import Calibrated, identified, opened, silent
from recalib.laboratory.data_set import DataSet
from recalib.laboratory.pictures.observed import LENS, doubt_of
from recalib.laboratory.pictures.session import Session
from recalib.laboratory.tables.columns import TIMES
from recalib.laboratory.tables.description import Description
from recalib.nominal.kinematics import Arm
from recalib.vision.lens_search import FEWEST as FEWEST_VIEWS
from recalib.vision.lens_search import find_lens, moved_lens
from recalib.vision.lenses import Lens
from recalib.vision.views import optics_kinds, optics_of, sighting


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
            session = Session.read(folder, arm)
            for before in sessions:
                if conflict := before.conflict(session):
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


def _lens_of(sessions: Sequence[Session]) -> tuple[Lens, str | None]:
    """The lens of a camera, by the pictures of its sessions or as given, and what is doubtful."""
    views = [(session.board, view) for session in sessions for view in session.views]
    given, fitted = sessions[0].lens, sessions[0].fitted
    if len(views) < FEWEST_VIEWS:
        return given, None
    found = find_lens(views, given.size)
    return found.lens if fitted else given, doubt_of(None if fitted else given, found, views)


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
