"""From a URDF and a table of measurements to a calibration and its cross-validated errors."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from os import PathLike
from pathlib import Path

import numpy as np

from recalib.errors import InvalidFile
from recalib.files.storage import read_file
from recalib.identification.board_scale import board_scale
from recalib.identification.calibration import Calibration
from recalib.identification.error_model import OFFSETS, ErrorModel
from recalib.identification.estimation import DOUBTFUL
from recalib.identification.frames import Frames
from recalib.identification.identifiability import Unidentifiable, unidentifiable_parameters
from recalib.identification.observations import Distance, Observations
from recalib.identification.repeatability import weigh
from recalib.identification.sequence import Fault, faults
from recalib.identification.validation import BLOCKWISE, GEOMETRIC, NOTHING, Validation, validate
from recalib.laboratory.correction import Correction
from recalib.laboratory.description import Description, read_description
from recalib.laboratory.knowledge import check_distances, checked_frames
from recalib.laboratory.measurements import OBSERVED, Measurements, read_measurements
from recalib.laboratory.nominal_checks import check_nominal
from recalib.laboratory.places import Place, found_places
from recalib.laboratory.urdf import corrected_urdf
from recalib.nominal.arms import arm_of
from recalib.nominal.descriptions import MOST, find_urdf, origin
from recalib.nominal.kinematics import Arm


@dataclass(frozen=True)
class Calibrated:
    """An arm, what was measured of it, and what follows.

    Attributes:
        urdf: the file that describes the arm.
        source: its bytes, as they were read.
        origin: which file it is, in words.
        table: the file with the measurements.
        observations: what it says.
        targets, sockets: their names, in the order of their numbers.
        instrument: its name.
        board_scale: the size of the board, by links as they are described, over its description.
        between: what is between nominal positions and the nominal kinematics, in words.
        frames: from which the identification started.
        validation: errors on rows that were not learned from, and the choice by them.
    """

    urdf: Path
    source: bytes
    origin: str
    table: Path
    observations: Observations
    targets: tuple[str, ...]
    sockets: tuple[str, ...]
    between: str | None
    frames: Frames
    validation: Validation
    instrument: str = "the instrument"
    board_scale: float = 1.0

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

    @cached_property
    def corrected(self) -> tuple[bytes, str]:
        """The URDF with its geometry, and the link that is the tool there."""
        return corrected_urdf(self.source, self.geometry)

    @cached_property
    def places(self) -> list[Place]:
        """Where instrument, targets and sockets are, of those that were not given."""
        names = self.targets, self.sockets
        if not self.worthwhile:
            return found_places(self.calibration, [], *names, self.arm.tool, self.instrument)
        tool = self.corrected[1]
        return found_places(self.geometry, self.unidentifiable, *names, tool, self.instrument)

    @cached_property
    def unidentifiable(self) -> list[Unidentifiable]:
        """The parameters of geometry that are not identifiable."""
        return unidentifiable_parameters(self.geometry, self.observations)

    @cached_property
    def faults(self) -> list[Fault]:
        """What the order of the rows shows: a lag, a drift, a jump."""
        return faults(self.geometry, self.observations, self.validation.counted)

    @property
    def calibration(self) -> Calibration:
        """What is best on rows that were not learned from."""
        return self.validation.calibration

    @property
    def correction(self) -> Correction:
        """What corrects commands, with no other file."""
        return Correction(self.source, self.calibration, self.observations.joints, self.targets)

    @property
    def counted(self) -> np.ndarray:
        """Numbers (from 0) of the rows that are not grossly off."""
        return np.flatnonzero(self.validation.counted)

    @property
    def doubted(self) -> np.ndarray:
        """Numbers (from 1) of the rows that are outliers: they have almost no weight."""
        unlikely = self.geometry.estimate.weights < DOUBTFUL
        return np.flatnonzero(unlikely | ~self.validation.counted) + 1

    @property
    def positions(self) -> np.ndarray:
        """Where the targets should be (n, 3) [m] in the arm's base, of the rows that count."""
        rows = self.observations[self.counted]
        poses = self.calibration.predict(rows.joints, rows.targets)
        return (np.linalg.inv(self.calibration.frames.base) @ poses)[:, :3, 3]

    @property
    def residuals(self) -> dict[str, np.ndarray]:
        """Of the rows that count, before and, if it is worthwhile, after; held out in blocks.

        (n, 3) m, or (n, 6) m and rad, along the axes of the arm's base.
        """
        kinds = {"before": NOTHING} | ({"after": self.validation.chosen} if self.worthwhile else {})
        held_out, turn = self.validation.held_out[BLOCKWISE], self.calibration.frames.base[:3, :3]
        rows = {name: held_out[kind][self.validation.counted] for name, kind in kinds.items()}
        return {
            name: (held.residuals.reshape(-1, 3) @ turn).reshape(held.residuals.shape)
            for name, held in rows.items()
        }


def calibrate_arm(
    urdf: str | PathLike[str],
    table: str | PathLike[str],
    description: str | PathLike[str] | Description | None = None,
    tool: str | None = None,
    base: str | None = None,
    on_progress: Callable[[str], None] = lambda line: None,
) -> Calibrated:
    """Identify an arm from measurements.

    Args:
        urdf: a path, or a name that `recalib.nominal.arms.find_urdf` knows.
        table: see docs/own_arm.md; or the folder that `recalib observe` wrote.
        description: what the table does not say itself.
        tool, base: link names; guessed where there is only one choice.
        on_progress: called with what is being done, in a line each.

    Raises RecalibError: an arm, a table or a description that cannot be used; nominal positions of
    another arm; frames that are not identifiable, or not where the description has them; a fit that
    did not work out.
    """
    path = find_urdf(urdf)
    source = read_file(path, MOST)
    arm = arm_of(source, path, tool, base)
    if description is not None and not isinstance(description, Description):
        description = read_description(description)
    given = description or Description()
    pictures = Path(table) if Path(table).is_dir() else None
    table = Path(table) if pictures is None else pictures / OBSERVED
    rows = read_measurements(table, arm, given)
    on_progress(its := origin(urdf, source))
    on_progress(f"{len(rows)} rows of {len(arm.joints)} joints, from {arm.base} to {arm.tool}")
    between = None
    if rows.nominal is not None:
        stand = None if given.instrument is None else np.linalg.inv(given.instrument)
        between = check_nominal(arm, rows.joints, rows.nominal, stand, given.target)
    observations, targets, sockets = observations_of(rows, given, table)
    instrument, scale = "the instrument", 1.0
    if pictures is not None:  # OpenCV is imported only for these
        from recalib.laboratory.observed import with_pixels

        observations, instrument, targets = with_pixels(observations, pictures)
    on_progress("initial estimate of instrument and target")
    poses = replace(observations, optics=None)
    frames = checked_frames(arm, poses, given.instrument, given.target)
    if observations.optics is not None:
        frames = replace(frames, optics_deviations=observations.optics.deviations)
        scale = board_scale(arm, observations, frames)
        observations = weigh(ErrorModel(arm, OFFSETS, frames), observations)
    check_distances(arm, observations, frames, sockets)
    validation = validate(arm, observations, frames, on_progress)
    return Calibrated(
        path,
        source,
        its,
        table,
        observations,
        targets,
        sockets,
        between,
        frames,
        validation,
        instrument,
        scale,
    )


def observations_of(
    rows: Measurements, given: Description, table: Path
) -> tuple[Observations, tuple[str, ...], tuple[str, ...]]:
    """What was measured, with the names of targets and of sockets."""
    targets, numbers = _numbered(rows.targets, len(rows))
    observations = Observations(rows.joints, rows.measured, numbers, times=rows.times)
    if rows.sockets is None:
        if given.distances:
            raise InvalidFile(
                table,
                "its description has a distance between sockets; the table has no column 'socket'",
            )
        return observations, targets, ()
    if given.instrument is not None:
        raise InvalidFile(table, "its description has an instrument; a ball in sockets needs none")
    sockets, where = _numbered(rows.sockets, len(rows))
    for pair in given.distances:
        for socket in pair:
            if socket not in sockets:
                raise InvalidFile(
                    table,
                    f"its description names socket {socket!r}; the table has {', '.join(sockets)}",
                )
    distances = [
        Distance(sockets.index(one), sockets.index(other), length)
        for (one, other), length in given.distances.items()
    ]
    return replace(observations, sockets=where, distances=distances), targets, sockets


def _numbered(labels: np.ndarray | None, count: int) -> tuple[tuple[str, ...], np.ndarray]:
    if labels is None:
        return ("the target",), np.zeros(count, dtype=int)
    names, numbers = np.unique(labels, return_inverse=True)
    return tuple(names.tolist()), numbers
