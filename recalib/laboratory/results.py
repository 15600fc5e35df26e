"""A calibrated arm, its measurements, and the results derived from both."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from recalib.errors import InvalidSetting, check_name
from recalib.identification.calibration import Calibration, turned
from recalib.identification.checks.gains import WrongGain, wrong_gain
from recalib.identification.checks.identifiability import Unidentifiable, unidentifiable_parameters
from recalib.identification.checks.misplaced import misplaced
from recalib.identification.checks.outliers import Exchanged, exchanged
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

HARDLY = 0.5  # of a prior deviation: above it, the prior decides a parameter, not the data


def without_shift(found: Sequence[Fault], mistake: str | None) -> list[Fault]:
    """Faults without a lag if the mistake, joints shifted by a row, already explains it."""
    shifted = mistake is not None and mistake.startswith(SHIFTED)
    return [fault for fault in found if not (shifted and fault.kind == LAG)]


@dataclass(frozen=True)
class Results:
    """A calibrated arm."""

    urdf: UrdfFile | None  # of the nominal arm; None if there is none
    data: DataSet
    frames: Frames  # the initial estimates
    validation: Validation  # held-out errors, and the correction chosen by them
    # scales of boards, distances between sockets or all positions, if nominal links are right
    scales: Mapping[str, Scale]
    mistake: str | None  # the likely mistake in the rows, in words; see `mistake_in`
    offset: str | None  # between the controller's positions and the URDF's kinematics, in words

    def predict(self, joints: ArrayLike, target: str | None = None) -> np.ndarray:
        """Predicted measurements: poses (n, 4, 4) [m] of a target in the instrument's frame.

        One posture gives one pose (4, 4). If only positions were measured, rotations are nominal.

        Args:
            joints: (n, joints) or (joints,) rad, or m for sliding joints.
            target: the name of the target (default: the first).

        Raises InvalidSetting (another shape), UnknownName.
        """
        count, names = len(self.arm.coupling.columns), self.data.sight_names
        given = self.arm.coupling.given("joints", joints, ("n",), ())
        if target is not None:
            check_name("target", target, names)
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
        """Whether some correction has a smaller held-out error than none."""
        return self.validation.chosen != NOTHING

    @property
    def geometry(self) -> Calibration:
        """The part of the calibration that a URDF can hold."""
        return self.validation.full[GEOMETRIC]

    @property
    def calibration(self) -> Calibration:
        """The calibration with the smallest errors on held-out rows."""
        return self.validation.calibration

    @property
    def correction(self) -> Correction:
        """The correction of commands, which can be saved in a file."""
        urdf = b"" if self.urdf is None else self.urdf.content
        names = tuple(self.data.sight_names)
        return Correction(urdf, self.calibration, self.data.observations.joints, names)

    @cached_property
    def corrected(self) -> tuple[bytes, str]:
        """The URDF with corrected geometry, and the name of its tool link.

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
        # even if the nominal arm fits, it may have an offset that is not identifiable
        by_nominal = found_places(self.calibration, [], self.data, self.arm.tool)
        pairs = zip(by_nominal, by_geometry, strict=True)
        return [replace(one, real_deviations=other.real_deviations) for one, other in pairs]

    @cached_property
    def unidentifiable(self) -> list[Unidentifiable]:
        """The geometric parameters that are not identifiable."""
        return unidentifiable_parameters(self.geometry, self.data.observations)

    @cached_property
    def parameters(self) -> list[Parameter]:
        """All geometric parameters, in the order of the error model."""
        names = self.data.targets, self.data.sockets, self.data.instruments
        return parameters_of(self.geometry.model, self.geometry.estimate, *names)

    @property
    def directions(self) -> list[tuple[Unidentifiable, str]]:
        """Unidentifiable geometric parameters, each with its name and those of its partners."""
        names = [parameter.name for parameter in self.parameters]
        return [
            (one, listed((names[number] for number in (one.parameter, *one.partners)), "or"))
            for one in self.unidentifiable
        ]

    @property
    def identified(self) -> list[dict[str, Any]]:
        """Geometric parameters: name, unit, value, deviation, and `decided_by` data or prior."""
        # a small deviation proves nothing: the prior of a useless parameter becomes narrow, too
        model = self.geometry.model
        by_prior = model.deviations <= HELD
        by_prior[[one.parameter for one in self.unidentifiable]] = True
        optics = model.optics_columns
        deviations = np.sqrt(np.diag(self.geometry.estimate.covariance)[optics])
        by_prior[optics] = deviations > HARDLY * model.deviations[optics]
        return [
            vars(parameter) | {"decided_by": "prior" if prior else "data"}
            for parameter, prior in zip(self.parameters, by_prior, strict=True)
        ]

    @cached_property
    def unseen(self) -> int:
        """Number of directions of the geometry that other postures would show, but no row does."""
        return Unseen(self.geometry.model, self.data.observations).directions.shape[1]

    @cached_property
    def mistaken(self) -> str | None:
        """The mistake that likely explains the outliers, in words."""
        return mistake_of_outliers(self.geometry, self.data.observations)

    @cached_property
    def faults(self) -> list[Fault]:
        """Faults that the order of the rows shows, such as a drift; none if a mistake is likely."""
        if self.mistaken:
            return []
        return without_shift(faults(self.geometry, self.data.observations), self.mistake)

    @cached_property
    def exchanged(self) -> Exchanged | None:
        """Outliers whose measurements fit the joints of other rows."""
        return exchanged(self.geometry, self.data.observations)

    @cached_property
    def misplaced(self) -> list[tuple[str, np.ndarray]]:
        """Frames that are not where they are stated to be, and how far they are off [m, rad]."""
        if self.validation.postures.still.any():  # its joint's error looks like a misplaced frame
            return []
        rows = self.data.observations[self.validation.counted]
        return [*misplaced(self.geometry, self.frames, rows)]

    @cached_property
    def wrong_gain(self) -> WrongGain | None:
        """A joint that moves more or less than its column says."""
        return wrong_gain(self.geometry, self.data.observations)

    @property
    def counted(self) -> np.ndarray:
        """Indices (from 0) of the rows whose errors count."""
        return np.flatnonzero(self.validation.judged(BLOCKWISE))

    @property
    def doubted(self) -> np.ndarray:
        """Numbers (from 1) of outliers: rows with almost no weight."""
        unlikely = self.geometry.estimate.weights < DOUBTFUL
        return np.flatnonzero(unlikely | ~self.validation.counted) + 1

    @property
    def positions(self) -> np.ndarray:
        """Predicted positions (n, 3) [m] of targets in the arm's base, for the rows that count."""
        rows = self.data.observations[self.counted]
        poses = self.calibration.predict(rows.joints, rows.targets)
        return (np.linalg.inv(self._bases) @ poses)[:, :3, 3]

    @property
    def _bases(self) -> np.ndarray:
        """Poses (n, 4, 4) [m] of the arm's base in the instrument, for the rows that count."""
        frames = self.calibration.frames
        return frames.bases[frames.sights[self.data.observations.targets[self.counted], 0]]

    @property
    def residuals(self) -> dict[str, np.ndarray]:
        """Held-out residuals (in blocks) of the rows that count, before and after correction.

        (n, 3) m, or (n, 6) m and rad, along the axes of the arm's base. No `after` without benefit.
        """
        kinds = {"before": NOTHING} | ({"after": self.validation.chosen} if self.worthwhile else {})
        held_out, turns = self.validation.held_out[BLOCKWISE], self._bases[:, :3, :3]
        return {
            name: turned(turns.swapaxes(1, 2), held_out[kind][self.counted].residuals)
            for name, kind in kinds.items()
        }
