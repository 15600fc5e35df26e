"""Folders that `observe` wrote, as a data set: poses and what their pixels say of the optics.

Each folder has pictures of one board by one camera. Folders may share a camera, or a board.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
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
        doubts: about lenses, in sentences without their full stops.
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

    @cached_property
    def optics(self) -> tuple[np.ndarray, list[np.ndarray]]:
        """The kinds (o,) of all optics, and the numbers of each session's optics.

        The parameters of each board come first, then of each lens that is estimated.
        """
        parts = {("board", one.board_name): np.arange(len(BOARD)) for one in self.sessions}
        fitted = [one.camera for one in self.sessions if one.fitted]
        parts |= {("camera", name): optics_kinds(self.lenses[name]) for name in fitted}
        kinds = np.concatenate([*parts.values()])
        places = np.split(np.arange(len(kinds)), np.cumsum([*map(len, parts.values())])[:-1])
        numbers = dict(zip(parts, places, strict=True))
        own = [
            [("board", one.board_name), *[("camera", one.camera)] * one.fitted]
            for one in self.sessions
        ]
        return kinds, [np.concatenate([numbers[name] for name in names]) for names in own]

    def corrected_lenses(self, optics: np.ndarray) -> dict[str, Lens]:
        """By camera, its lens with the corrections (o,) of a calibration."""
        lenses = dict(self.lenses)
        for session, own in zip(self.sessions, self.optics[1], strict=True):
            if session.fitted:
                lens = self.lenses[session.camera]
                lenses[session.camera] = moved_lens(lens, optics[own[len(BOARD) :]]) or lens
        return lenses

    def lens_files(self, optics: np.ndarray) -> dict[str, bytes]:
        """Files of the lenses with corrections (o,), by their names."""
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
    (kinds, numbers), tables = cell.optics, [session.rows for session in cell.sessions]
    for session, own in zip(cell.sessions, numbers, strict=True):
        lens, kind = cell.lenses[session.camera], (session.fitted, session.in_hand)
        views = [sighting(session.board, lens, view, *kind) for view in session.views]
        found, part = optics_of(lens, views)
        poses.append(found)
        parts.append(_placed(part, own, kinds))
    cameras = _in_words("camera", [session.camera for session in cell.sessions])
    boards = _in_words("board", [session.board_name for session in cell.sessions])
    ends = [
        (board, camera) if session.in_hand else (camera, board)
        for session, camera, board in zip(cell.sessions, cameras, boards, strict=True)
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
    return DataSet(
        observations,
        targets,
        instruments=instruments,
        known=known,
        sights=np.array([[instruments.index(one), targets.index(other)] for one, other in ends]),
        tables=tuple(rows.path for rows in tables),
        boards=tuple(dict.fromkeys(boards)),
        doubts=cell.doubts,
        lens_files=cell.lens_files,
    )


def _lens_of(sessions: Sequence[Session]) -> tuple[Lens, str | None]:
    """The lens of a camera, by the pictures of its sessions or as given, and a doubt about it."""
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
    """The arrays of a session's optics, with its columns among the cell's."""
    count, size = len(part.slopes), len(kinds)
    slopes, gradient = np.zeros((count, 6, size)), np.zeros((count, size))
    information = np.zeros((count, size, size))
    slopes[..., own], gradient[:, own] = part.slopes, part.gradient
    information[:, own[:, None], own] = part.information
    return part.spread, slopes, information, gradient, part.pixels
