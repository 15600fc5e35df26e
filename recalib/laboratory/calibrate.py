"""From a URDF and a table of measurements to what is known of the arm, and what that is worth."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from os import PathLike
from pathlib import Path

import numpy as np

from recalib.errors import InvalidFile
from recalib.identification.calibration import Calibration
from recalib.identification.estimation import DOUBTFUL
from recalib.identification.frames import Frames
from recalib.identification.observations import Distance, Observations
from recalib.identification.openness import Open, open_parameters
from recalib.identification.sequence import Fault, faults
from recalib.identification.validation import BLOCKWISE, GEOMETRIC, NOTHING, Validation, validate
from recalib.laboratory.correction import Correction
from recalib.laboratory.description import Description, read_description
from recalib.laboratory.knowledge import check_distances, first_frames
from recalib.laboratory.measurements import Measurements, read_measurements
from recalib.laboratory.places import Place, found_places
from recalib.laboratory.sanity import Fit, check_nominal
from recalib.laboratory.urdf import corrected_urdf
from recalib.nominal.arms import arm_of
from recalib.nominal.descriptions import MOST, find_urdf, origin
from recalib.nominal.kinematics import Arm
from recalib.storage import read_file


@dataclass(frozen=True)
class Calibrated:
    """An arm, what was seen of it, and what follows.

    Attributes:
        urdf: the file that describes the arm.
        source: its bytes, as they were read.
        origin: which file it is, in words.
        table: the file with the measurements.
        seen: what it says.
        targets, sockets: their names, in the order of their numbers.
        beside: frames between the nominal positions and the nominal kinematics, if they differ.
        frames: from which the identification started.
        validation: errors on rows that were not learned from, and the choice by them.
    """

    urdf: Path
    source: bytes
    origin: str
    table: Path
    seen: Observations
    targets: tuple[str, ...]
    sockets: tuple[str, ...]
    beside: Fit | None
    frames: Frames
    validation: Validation

    @property
    def arm(self) -> Arm:
        """The nominal arm."""
        return self.geometry.model.nominal

    @property
    def worthwhile(self) -> bool:
        """Whether correcting is better than doing nothing."""
        return self.validation.chosen != NOTHING

    @property
    def geometry(self) -> Calibration:
        """What a URDF can hold."""
        return self.validation.full[GEOMETRIC]

    @property
    def readable(self) -> Calibration:
        """What all files are of that people read: geometry, as in the URDF, or the nominal arm."""
        return self.geometry if self.worthwhile else self.calibration

    @cached_property
    def corrected(self) -> tuple[bytes, str]:
        """The URDF with its geometry, and the link that is the tool there."""
        return corrected_urdf(self.source, self.geometry)

    @cached_property
    def places(self) -> list[Place]:
        """Where instrument, targets and sockets are, of those that were not given."""
        left_open, tool = [], self.arm.tool
        if self.worthwhile:
            left_open, tool = self.left_open, self.corrected[1]
        return found_places(self.readable, left_open, self.targets, self.sockets, tool)

    @cached_property
    def left_open(self) -> list[Open]:
        """The parameters of geometry that were not told apart."""
        return open_parameters(self.geometry, self.seen)

    @cached_property
    def faults(self) -> list[Fault]:
        """What the order of the rows shows: a lag, a drift, a jump."""
        return faults(self.geometry, self.seen, self.validation.counted)

    @property
    def calibration(self) -> Calibration:
        """What is best on rows that were not learned from."""
        return self.validation.calibration

    @property
    def correction(self) -> Correction:
        """What corrects commands, with no other file."""
        return Correction(self.source, self.calibration, self.seen.joints, self.targets)

    @property
    def counted(self) -> np.ndarray:
        """Numbers (from 0) of the rows that are not grossly off."""
        return np.flatnonzero(self.validation.counted)

    @property
    def doubted(self) -> np.ndarray:
        """Numbers (from 1) of the rows that did not fit to the others and hardly counted."""
        unlikely = self.geometry.estimate.weights < DOUBTFUL
        return np.flatnonzero(unlikely | ~self.validation.counted) + 1

    def missed(self, kind: str) -> np.ndarray:
        """By how much the rows that count were missed, held out in blocks, if `kind` is done.

        (n, 3) m or (n, 6) m and rad, along the axes of the instrument.
        """
        return self.validation.misses[BLOCKWISE][kind][self.counted]


def calibrate_arm(
    urdf: str | PathLike,
    table: str | PathLike,
    description: str | PathLike | Description | None = None,
    tool: str | None = None,
    base: str | None = None,
    say: Callable[[str], None] = lambda line: None,
) -> Calibrated:
    """Identify an arm from measurements.

    Args:
        urdf: a path, or a name that `recalib.nominal.arms.find_urdf` knows.
        table: see docs/own_arm.md.
        description: what the table does not say itself.
        tool, base: link names; guessed where there is only one choice.
        say: is told what is being done, in a line each.

    Raises RecalibError: an arm, a table or a description that cannot be used; nominal positions of
    another arm; frames that cannot be told, or that are not where the description has them; a fit
    that did not work out.
    """
    path = find_urdf(urdf)
    source = read_file(path, MOST)
    arm = arm_of(source, path, tool, base)
    if description is not None and not isinstance(description, Description):
        description = read_description(description)
    said = description or Description()
    rows = read_measurements(table, arm, said)
    say(its := origin(urdf, source))
    say(f"{len(rows)} rows of {len(arm.joints)} joints, from {arm.base} to {arm.tool}")
    beside = None
    known = None if said.instrument is None else np.linalg.inv(said.instrument)
    if rows.nominal is not None:
        point = None if said.target is None else said.target[:3, 3]
        beside = check_nominal(arm, rows.coordinates, rows.nominal, known, point)
    seen, targets, sockets = _observations(rows, said, Path(table))
    say("where instrument and target are: a first guess")
    frames = first_frames(arm, seen, said.instrument, said.target)
    check_distances(arm, seen, frames, sockets)
    validation = validate(arm, seen, frames, say)
    return Calibrated(
        path, source, its, Path(table), seen, targets, sockets, beside, frames, validation
    )


def _observations(
    rows: Measurements, said: Description, table: Path
) -> tuple[Observations, tuple[str, ...], tuple[str, ...]]:
    """What was seen, with the names of targets and of sockets."""
    targets, numbers = _numbered(rows.targets, len(rows))
    measured = rows.positions
    if rows.rotations is not None:
        measured = np.tile(np.eye(4), (len(rows), 1, 1))
        measured[:, :3, :3], measured[:, :3, 3] = rows.rotations, rows.positions
    seen = Observations(rows.coordinates, measured, numbers, times=rows.times)
    if rows.sockets is None:
        if said.distances:
            raise InvalidFile(
                table,
                "its description has a distance between sockets; the table has no column 'socket'",
            )
        return seen, targets, ()
    if said.instrument is not None:
        raise InvalidFile(table, "its description has an instrument; a ball in sockets needs none")
    sockets, where = _numbered(rows.sockets, len(rows))
    for pair in said.distances:
        for socket in pair:
            if socket not in sockets:
                raise InvalidFile(
                    table,
                    f"its description names socket {socket!r}; the table has {', '.join(sockets)}",
                )
    distances = [
        Distance(*map(sockets.index, pair), length) for pair, length in said.distances.items()
    ]
    return replace(seen, sockets=where, distances=distances), targets, sockets


def _numbered(labels: np.ndarray | None, count: int) -> tuple[tuple[str, ...], np.ndarray]:
    if labels is None:
        return ("the target",), np.zeros(count, dtype=int)
    names, numbers = np.unique(labels, return_inverse=True)
    return tuple(names.tolist()), numbers
