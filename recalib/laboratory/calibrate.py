"""From a URDF and a table of measurements to a calibration and its cross-validated errors."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from recalib.errors import InvalidFile
from recalib.files.storage import read_file
from recalib.identification.calibration import Calibration, turned
from recalib.identification.checks.couplings import Coupling, coupling
from recalib.identification.checks.diagnostics import Untrustworthy
from recalib.identification.checks.identifiability import Unidentifiable, unidentifiable_parameters
from recalib.identification.checks.repeatability import weigh
from recalib.identification.checks.scales import Scale, scales
from recalib.identification.checks.sequence import LAG, Fault, faults
from recalib.identification.estimation import DOUBTFUL
from recalib.identification.model.error_model import OFFSETS, ErrorModel
from recalib.identification.model.frames import Frames
from recalib.identification.model.observations import Observations
from recalib.identification.unseen import Unseen
from recalib.identification.validation import BLOCKWISE, GEOMETRIC, NOTHING, Validation, validate
from recalib.laboratory.arms.urdf import corrected_urdf
from recalib.laboratory.correction.archive import Correction
from recalib.laboratory.places import INSTRUMENT, Place, found_places
from recalib.laboratory.tables.description import Description, read_description
from recalib.laboratory.tables.fault_words import in_words
from recalib.laboratory.tables.knowledge import check_distances, frames_by_sights, mistake_in
from recalib.laboratory.tables.measurements import OBSERVED, read_measurements
from recalib.laboratory.tables.nominal_checks import SHIFTED, check_nominal
from recalib.laboratory.tables.observations import observations_of
from recalib.nominal.arms import arm_of
from recalib.nominal.descriptions import MOST, find_urdf, origin
from recalib.nominal.kinematics import Arm
from recalib.spelling import counted

if TYPE_CHECKING:  # OpenCV is imported only for pictures
    from recalib.laboratory.pictures.sessions import Sighted


@dataclass(frozen=True)
class Calibrated:
    """An arm, what was measured of it, and what follows.

    Attributes:
        urdf: the file that describes the arm.
        source: its bytes, as they were read.
        origin: which file it is, in words.
        tables: the files with the measurements; several are each of another sight.
        observations: what they say.
        targets, sockets: their names, in the order of their numbers.
        between: what is between nominal positions and the nominal kinematics, in words.
        frames: from which the identification started.
        validation: errors on rows that were not learned from, and the choice by them.
        instruments: their names, in the order of their numbers.
        scales: of boards, of distances between sockets or of all positions, by links as long as the
            URDF has them.
        mistake: what is likely wrong with the rows, in words; see `mistake_in`.
        sighted: what cameras saw, with their lenses; None without cameras.
    """

    urdf: Path
    source: bytes
    origin: str
    tables: tuple[Path, ...]
    observations: Observations
    targets: tuple[str, ...]
    sockets: tuple[str, ...]
    between: str | None
    frames: Frames
    validation: Validation
    instruments: tuple[str, ...] = INSTRUMENT
    scales: Mapping[str, Scale] = field(default_factory=dict)
    mistake: str | None = None
    sighted: "Sighted | None" = None

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
        by_geometry = self.places_by(self.geometry, self.unidentifiable, self.corrected[1])
        if self.worthwhile:
            return by_geometry
        # an arm that looks right may have an offset that no measurement tells, all the same
        own = self.places_by(self.calibration, [], self.arm.tool)
        pairs = zip(own, by_geometry, strict=True)
        return [replace(one, real_deviations=its.real_deviations) for one, its in pairs]

    def places_by(
        self, calibration: Calibration, unidentifiable: Sequence[Unidentifiable], tool: str
    ) -> list[Place]:
        """The same by a calibration; see `found_places`."""
        names = self.ends, self.sockets, tool, self.instruments
        return found_places(calibration, unidentifiable, *names)

    @property
    def ends(self) -> list[str]:
        """What the targets are, in words."""
        return _ends(self.targets, self.observations)

    @property
    def sights(self) -> list[str]:
        """The names of targets, by the instruments that see them if there are several."""
        return sight_names(self.instruments, self.targets, self.frames.sights)

    @cached_property
    def unidentifiable(self) -> list[Unidentifiable]:
        """The parameters of geometry that are not identifiable."""
        return unidentifiable_parameters(self.geometry, self.observations)

    @cached_property
    def unseen(self) -> int:
        """How many directions of the geometry no row shows, though other postures would."""
        return Unseen(self.geometry.model, self.observations).directions.shape[1]

    @cached_property
    def faults(self) -> list[Fault]:
        """What the order of the rows shows: a lag, a drift, a jump."""
        found = faults(self.geometry, self.observations)
        return _not_told(found, self.mistake)

    @cached_property
    def coupling(self) -> Coupling | None:
        """A joint that does not turn as its column says."""
        return coupling(self.geometry, self.observations)

    @property
    def calibration(self) -> Calibration:
        """What is best on rows that were not learned from."""
        return self.validation.calibration

    @property
    def correction(self) -> Correction:
        """What corrects commands, with no other file."""
        return Correction(
            self.source, self.calibration, self.observations.joints, tuple(self.sights)
        )

    @property
    def counted(self) -> np.ndarray:
        """Numbers (from 0) of the rows whose errors count."""
        return np.flatnonzero(self.validation.judged(BLOCKWISE))

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
        return (np.linalg.inv(self._bases) @ poses)[:, :3, 3]

    @property
    def _bases(self) -> np.ndarray:
        """The arm's base in the instrument (n, 4, 4) [m], of each row that counts."""
        frames = self.calibration.frames
        return frames.bases[frames.sights[self.observations.targets[self.counted], 0]]

    @property
    def residuals(self) -> dict[str, np.ndarray]:
        """Of the rows that count, before and, if it is worthwhile, after; held out in blocks.

        (n, 3) m, or (n, 6) m and rad, along the axes of the arm's base.
        """
        kinds = {"before": NOTHING} | ({"after": self.validation.chosen} if self.worthwhile else {})
        held_out, turns = self.validation.held_out[BLOCKWISE], self._bases[:, :3, :3]
        rows = {name: held_out[kind][self.counted] for name, kind in kinds.items()}
        return {name: turned(turns.swapaxes(1, 2), its.residuals) for name, its in rows.items()}


def calibrate_arm(
    urdf: str | PathLike[str],
    table: str | PathLike[str] | Sequence[str | PathLike[str]],
    description: str | PathLike[str] | Description | None = None,
    tool: str | None = None,
    base: str | None = None,
    on_progress: Callable[[str], None] = lambda line: None,
) -> Calibrated:
    """Identify an arm from measurements.

    Args:
        urdf: a path, or a name that `recalib.nominal.arms.find_urdf` knows.
        table: see docs/own_arm.md; or the folder that `recalib observe` wrote, or several.
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
    paths = [Path(table)] if isinstance(table, str | PathLike) else [*map(Path, table)]
    if len(paths) > 1:
        _check_several(paths, given)
    folders = [path for path in paths if path.is_dir()]
    tables = tuple(path / OBSERVED if path in folders else path for path in paths)
    measured = [read_measurements(path, arm, given) for path in tables]
    on_progress(its := origin(urdf, source))
    between = None
    for rows in measured:
        moving = counted(len(arm.joints), "joint")
        on_progress(f"{len(rows)} rows of {moving}, from {arm.base} to {arm.tool}")
        if rows.nominal is not None:
            stand = None if given.instrument is None else np.linalg.inv(given.instrument)
            between = check_nominal(arm, rows.joints, rows.nominal, stand, given.target)
    read = [observations_of(rows, given, path) for rows, path in zip(measured, tables, strict=True)]
    observations, targets, sockets = read[0]
    scaled: tuple[str, ...] = ("positions",)
    instruments, sights, sighted = INSTRUMENT, None, None
    if folders:  # OpenCV is imported only for these
        from recalib.laboratory.pictures.sessions import with_pixels

        sighted = with_pixels([rows for rows, *_ in read], folders)
        observations, instruments, targets, sights, scaled, *_ = sighted
    on_progress("initial estimate of instrument and target")
    names = sight_names(instruments, targets, sights)
    known = given.instrument, given.target
    without_optics = replace(observations, optics=None)
    frames = given.stated_in(frames_by_sights(arm, without_optics, sights, names, *known))
    if observations.optics is not None:
        frames = frames.with_optics(observations.optics)
        observations = weigh(ErrorModel(arm, OFFSETS, frames), observations)
    if observations.sockets is not None:
        pairs = [(sockets[one], sockets[other]) for one, other, *_ in observations.distances]
        scaled = tuple(f"the distance between {one} and {other}" for one, other in pairs)
    check_distances(arm, observations, frames, sockets)
    mistake = mistake_in(arm, observations, frames)
    try:
        validation = validate(arm, observations, frames, on_progress)
    except Untrustworthy as error:
        session = observations, frames, tables, instruments, _ends(targets, observations)
        reasons = [in_words(fault, *session) for fault in _not_told(error.faults, mistake)]
        reasons += [f"likely: {mistake}"] if mistake else []
        reasons += sighted.doubts if sighted else []
        ranges = rows_of(observations, names) if len(tables) > 1 else []
        raise Untrustworthy("; ".join([str(error), *reasons, *ranges])) from None
    return Calibrated(
        path,
        source,
        its,
        tables,
        observations,
        targets,
        sockets,
        between,
        frames,
        validation,
        instruments,
        dict(zip(scaled, scales(arm, observations[validation.counted], frames), strict=True)),
        mistake,
        sighted,
    )


def _not_told(found: Sequence[Fault], mistake: str | None) -> list[Fault]:
    """Faults without the lag that a mistake names already: rows that are shifted by one."""
    shifted = mistake is not None and mistake.startswith(SHIFTED)
    return [fault for fault in found if not (shifted and fault.kind == LAG)]


def _ends(targets: Sequence[str], observations: Observations) -> list[str]:
    plain = len(targets) == 1 or observations.optics is not None
    return [name if plain else f"target {name}" for name in targets]


def sight_names(
    instruments: Sequence[str], targets: Sequence[str], sights: np.ndarray | None
) -> list[str]:
    """The names of targets, each by an instrument if there are several of them."""
    if sights is None or len(instruments) == 1:
        return [*targets]
    return [f"{targets[target]} by {instruments[instrument]}" for instrument, target in sights]


def rows_of(observations: Observations, names: Sequence[str]) -> list[str]:
    """Which rows are of each sight of cameras, in words."""
    ends = np.cumsum(np.bincount(observations.targets)).tolist()
    parts = zip([0, *ends[:-1]], ends, names, strict=True)
    return [f"rows {before + 1} to {last}: {name}" for before, last, name in parts]


def _check_several(paths: Sequence[Path], given: Description) -> None:
    """Raise InvalidFile unless they are folders of several cameras, and nothing else is known."""
    for path in paths:
        if not path.is_dir():
            valid = "expected: one, or the folders that observe wrote"
            raise InvalidFile(path, f"it is one of {len(paths)} tables; {valid}")
    if given.instrument is not None or given.target is not None:
        raise InvalidFile(
            paths[1],
            "the description has an instrument or a target, which is for one camera; try: without",
        )
