"""A calibrated arm, its measurements, and what follows from both."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from recalib.errors import InvalidSetting, UnknownName
from recalib.identification.calibration import Calibration, turned
from recalib.identification.checks.gains import WrongGain, wrong_gain
from recalib.identification.checks.identifiability import Unidentifiable, unidentifiable_parameters
from recalib.identification.checks.outliers import Displaced, Exchanged, displaced, exchanged
from recalib.identification.checks.scales import Scale
from recalib.identification.checks.sequence import LAG, Fault, faults
from recalib.identification.estimation import DOUBTFUL
from recalib.identification.model.frames import HELD, Frames
from recalib.identification.parameters import Parameter, parameters_of
from recalib.identification.unseen import Unseen
from recalib.identification.validation import BLOCKWISE, GEOMETRIC, NOTHING, Validation
from recalib.laboratory.correction import Commands, Correction
from recalib.laboratory.data_set import DataSet
from recalib.laboratory.places import Place, found_places
from recalib.laboratory.plausibility.mistakes import mistake_of_outliers
from recalib.laboratory.plausibility.steps import SHIFTED
from recalib.laboratory.urdf.origins import corrected_urdf
from recalib.nominal.descriptions import UrdfFile
from recalib.nominal.kinematics import Arm
from recalib.spelling import listed

HARDLY = 0.5  # of a prior deviation: data that reduce it by less have not decided


def without_shift(found: Sequence[Fault], mistake: str | None) -> list[Fault]:
    """Faults without the lag if a mistake names it already: rows that are shifted by one."""
    shifted = mistake is not None and mistake.startswith(SHIFTED)
    return [fault for fault in found if not (shifted and fault.kind == LAG)]


@dataclass(frozen=True)
class Results:
    """A calibrated arm."""

    urdf: UrdfFile | None  # of the nominal arm; None if there is none
    data: DataSet
    frames: Frames  # from which the identification started
    validation: Validation  # held-out errors, and the choice by them
    # of boards, distances between sockets or all positions, if links are as long as nominal ones
    scales: Mapping[str, Scale]
    mistake: str | None  # the likely one in the rows, in words; see `mistake_in`
    offset: str | None  # of nominal positions in the rows from nominal kinematics, in words

    def predict(self, joints: ArrayLike, target: str | None = None) -> np.ndarray:
        """Poses (n, 4, 4) [m] of a target in the instrument's frame: what it should measure.

        Or one (4, 4) of one posture. If only positions were measured, the rotations are nominal.

        Args:
            joints: (n, joints) or (joints,) rad, or m where a joint slides.
            target: the name of the target (default: the first).

        Raises InvalidSetting (another shape), UnknownName.
        """
        count, names = len(self.arm.coupling.columns), self.data.sight_names
        given = self.arm.coupling.given("joints", joints, ("n",), ())
        if target is not None and target not in names:
            raise UnknownName("target", target, names)
        number = 0 if target is None else names.index(target)
        postures = self.arm.coupling.joints(given.reshape(-1, count))
        poses = self.calibration.predict(postures, np.full(len(postures), number))
        return poses.reshape(*given.shape[:-1], 4, 4)

    def correct(
        self,
        poses: ArrayLike,
        near: ArrayLike | None = None,
        target: str | Sequence[str] | None = None,
        frame: str | None = None,
    ) -> Commands:
        """Commands that take the real arm to desired poses; see `Correction.correct`."""
        return self.correction.correct(poses, near, target, frame)

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
        """The part of the calibration that a URDF can hold."""
        return self.validation.full[GEOMETRIC]

    @property
    def calibration(self) -> Calibration:
        """The calibration with the smallest errors on rows that were not learned from."""
        return self.validation.calibration

    @property
    def correction(self) -> Correction:
        """Corrects commands; can be saved in a file."""
        urdf = b"" if self.urdf is None else self.urdf.content
        names = tuple(self.data.sight_names)
        return Correction(urdf, self.calibration, self.data.observations.joints, names)

    @cached_property
    def corrected(self) -> tuple[bytes, str]:
        """The URDF with corrected geometry, and the link that is the tool there.

        Raises InvalidSetting without a URDF.
        """
        if self.urdf is None:
            raise InvalidSetting("urdf", None, "the file of the arm; try: calibrate_arm")
        return corrected_urdf(self.urdf.content, self.geometry)

    @cached_property
    def places(self) -> list[Place]:
        """Poses of instruments, targets and sockets that were not given."""
        tool = self.arm.tool if self.urdf is None else self.corrected[1]
        by_geometry = found_places(self.geometry, self.unidentifiable, self.data, tool)
        if self.worthwhile:
            return by_geometry
        # an arm that looks right may still have an offset that is not identifiable
        by_nominal = found_places(self.calibration, [], self.data, self.arm.tool)
        pairs = zip(by_nominal, by_geometry, strict=True)
        return [replace(one, real_deviations=other.real_deviations) for one, other in pairs]

    @cached_property
    def unidentifiable(self) -> list[Unidentifiable]:
        """The parameters of geometry that are not identifiable."""
        return unidentifiable_parameters(self.geometry, self.data.observations)

    @cached_property
    def parameters(self) -> list[Parameter]:
        """All parameters of geometry, in the order of the error model."""
        names = self.data.targets, self.data.sockets, self.data.instruments
        return parameters_of(self.geometry.model, self.geometry.estimate, *names)

    @property
    def directions(self) -> list[tuple[Unidentifiable, str]]:
        """Parameters of geometry that are not identifiable, each with its partners in words."""
        names = [parameter.name for parameter in self.parameters]
        return [
            (one, listed((names[number] for number in (one.parameter, *one.partners)), "or"))
            for one in self.unidentifiable
        ]

    @property
    def identified(self) -> list[dict[str, Any]]:
        """The parameters: name, unit, value, deviation, and `decided_by` data or prior."""
        # not by a small deviation: the prior of what explains nothing becomes narrow
        model = self.geometry.model
        by_prior = model.deviations <= HELD
        by_prior[[one.parameter for one in self.unidentifiable]] = True
        optics = model.optics_columns
        known = np.sqrt(np.diag(self.geometry.estimate.covariance)[optics])
        by_prior[optics] = known > HARDLY * model.deviations[optics]
        return [
            vars(parameter) | {"decided_by": "prior" if prior else "data"}
            for parameter, prior in zip(self.parameters, by_prior, strict=True)
        ]

    @cached_property
    def unseen(self) -> int:
        """How many directions of the geometry no row shows, though other postures would."""
        return Unseen(self.geometry.model, self.data.observations).directions.shape[1]

    @cached_property
    def mistaken(self) -> str | None:
        """What is likely wrong with outliers, in words."""
        return mistake_of_outliers(self.geometry, self.data.observations)

    @cached_property
    def faults(self) -> list[Fault]:
        """What the order of the rows shows: a lag, a drift, a jump; unless rows are mistaken."""
        if self.mistaken:
            return []
        return without_shift(faults(self.geometry, self.data.observations), self.mistake)

    @cached_property
    def exchanged(self) -> Exchanged | None:
        """Outliers whose measurements fit the joints of other rows."""
        return exchanged(self.geometry, self.data.observations)

    @cached_property
    def displaced(self) -> list[Displaced]:
        """Runs of outliers that are off alike; unless rows are mistaken."""
        return [] if self.mistaken else displaced(self.geometry, self.data.observations)

    @cached_property
    def wrong_gain(self) -> WrongGain | None:
        """A joint that does not turn as its column says."""
        return wrong_gain(self.geometry, self.data.observations)

    @property
    def counted(self) -> np.ndarray:
        """Numbers (from 0) of the rows whose errors count."""
        return np.flatnonzero(self.validation.judged(BLOCKWISE))

    @property
    def doubted(self) -> np.ndarray:
        """Numbers (from 1) of the rows that are outliers, with almost no weight."""
        unlikely = self.geometry.estimate.weights < DOUBTFUL
        return np.flatnonzero(unlikely | ~self.validation.counted) + 1

    @property
    def positions(self) -> np.ndarray:
        """Predicted positions (n, 3) [m] of the targets in the arm's base, of rows that count."""
        rows = self.data.observations[self.counted]
        poses = self.calibration.predict(rows.joints, rows.targets)
        return (np.linalg.inv(self._bases) @ poses)[:, :3, 3]

    @property
    def _bases(self) -> np.ndarray:
        """The arm's base in the instrument's frame (n, 4, 4) [m], of each row that counts."""
        frames = self.calibration.frames
        return frames.bases[frames.sights[self.data.observations.targets[self.counted], 0]]

    @property
    def residuals(self) -> dict[str, np.ndarray]:
        """Of the rows that count, before and, if it is worthwhile, after; held out in blocks.

        (n, 3) m, or (n, 6) m and rad, along the axes of the arm's base.
        """
        kinds = {"before": NOTHING} | ({"after": self.validation.chosen} if self.worthwhile else {})
        held_out, turns = self.validation.held_out[BLOCKWISE], self._bases[:, :3, :3]
        return {
            name: turned(turns.swapaxes(1, 2), held_out[kind][self.counted].residuals)
            for name, kind in kinds.items()
        }
