"""Calibration: from measurements to a calibrated arm and its cross-validated errors."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from recalib.arrays import array_of, check_rotations
from recalib.errors import InvalidSetting
from recalib.files.quantities import ANGLE, LENGTH, TIME, Quantity
from recalib.identification.checks.diagnostics import Untrustworthy
from recalib.identification.checks.scales import returning, scales
from recalib.identification.model.error_model import OFFSETS, ErrorModel
from recalib.identification.validation import validate
from recalib.laboratory.data_set import DataSet, data_set
from recalib.laboratory.plausibility.knowledge import check_distances, frames_of, mistake_in
from recalib.laboratory.plausibility.mistakes import check_nominal
from recalib.laboratory.report.doubts import fault_in_words
from recalib.laboratory.report.summary import summary
from recalib.laboratory.results import Results, without_shift
from recalib.laboratory.tables.columns import SOCKETS, TARGETS, TIMES
from recalib.laboratory.tables.description import Description, read_description
from recalib.laboratory.tables.measurements import Measurements, check_measured, read_measurements
from recalib.nominal.arms import arm_of
from recalib.nominal.descriptions import UrdfFile
from recalib.nominal.kinematics import Arm
from recalib.spelling import counted

AnyPath = str | PathLike[str]
Progress = Callable[[str], None]


class Calibrated(Results):
    """A calibrated arm: `summary()`, `predict(joints)`, `correct(poses)`."""

    def summary(self) -> str:
        """The printed summary: errors before and after, and the identified arm."""
        return summary(self)


def silent(line: str) -> None:
    """Report no progress."""


def calibrate(
    arm: Arm,
    joints: ArrayLike,
    measured: ArrayLike | None = None,
    *,
    targets: Sequence[object] | np.ndarray | None = None,
    sockets: Sequence[object] | np.ndarray | None = None,
    distances: Mapping[tuple[Any, Any], float] | None = None,
    times: ArrayLike | None = None,
    instrument: ArrayLike | None = None,
    target: ArrayLike | None = None,
    on_progress: Progress = silent,
) -> Calibrated:
    """Identify the errors of an arm from arrays of measurements.

    Args:
        arm: the nominal one.
        joints: (n, joints) rad, or m where a joint slides, that the controller reported; without
            joints that follow others.
        measured: poses (n, 4, 4) or positions (n, 3) [m] of a target on the tool, in the frame of
            the instrument.
        targets: (n,) names of the targets, if there are several.
        sockets: (n,) instead of `measured`: names of the sockets that held a ball on the tool.
        distances: m between the centres of two sockets, by their names.
        times: (n,) s when rows were measured, in this order.
        instrument: (4, 4) m in the arm's base, if known; otherwise identified.
        target: (4, 4) m in the tool link's frame, if known; otherwise identified.
        on_progress: called with the current step, in a line each.

    Raises InvalidSetting: arrays of other shapes; and as `calibrate_arm`.
    """
    if not isinstance(arm, Arm):
        raise InvalidSetting("arm", type(arm).__name__, "an Arm, as load_arm returns")
    moving = array_of("joints", joints, ("n", len(arm.coupling.columns)))
    for kind, chosen in ((ANGLE, ~arm.coupling.slides), (LENGTH, arm.coupling.slides)):
        _check_unit("joints", moving[:, chosen], kind)
    count, poses, columns = len(moving), None, {}
    if measured is not None:
        poses = array_of("measured", measured, (count, 3), (count, 4, 4))
        _check_unit("measured", poses if poses.ndim == 2 else poses[:, :3, 3], LENGTH)
        if poses.ndim == 3:
            check_rotations("measured", poses)
    if times is not None:
        columns[TIMES.name] = array_of("times", times, (count,))
        _check_unit("times", columns[TIMES.name], TIME)
    for name, labels in ((TARGETS.name, targets), (SOCKETS.name, sockets)):
        if labels is not None:
            columns[name] = np.asarray(labels).astype(str)
            if columns[name].shape != (count,):
                raise InvalidSetting(name, f"of shape {columns[name].shape}", f"{count} names")
    pairs = {}
    for (one, other), length in (distances or {}).items():
        pairs[min(str(one), str(other)), max(str(one), str(other))] = float(length)
    frames = _frame("instrument", instrument), _frame("target", target)
    rows = Measurements(Path("the arrays"), moving, poses, columns)
    known = Description({}, *frames, pairs)
    return identified(arm, data_set(check_measured(rows), known, arm), on_progress=on_progress)


def _frame(name: str, given: ArrayLike | None) -> np.ndarray | None:
    if given is None:
        return None
    pose = array_of(name, given, (4, 4))
    check_rotations(name, pose)
    _check_unit(name, pose[:3, 3], LENGTH)
    return pose


def _check_unit(name: str, numbers: np.ndarray, kind: Quantity) -> None:
    """Raise InvalidSetting of numbers that are too large for their unit."""
    if (largest := np.abs(numbers).max(initial=0)) > kind.farthest:
        farthest = kind.write(kind.farthest)
        raise InvalidSetting(name, f"up to {largest:.3g}", f"up to {farthest}; is its unit right?")


def calibrate_arm(
    urdf: AnyPath,
    table: AnyPath,
    description: AnyPath | Description | None = None,
    tool: str | None = None,
    base: str | None = None,
    on_progress: Progress = silent,
) -> Calibrated:
    """Identify the errors of an arm from a table of measurements.

    Args:
        urdf: a path, or a name that `recalib.nominal.arms.find_urdf` knows.
        table: see docs/own_arm.md.
        description: what the table cannot express.
        tool, base: link names; needed only if there are several ends.
        on_progress: called with the current step, in a line each.

    Raises RecalibError: an arm, a table or a description that cannot be used; nominal positions of
    another arm; frames that are not identifiable, or contradict the description; a fit that cannot
    be trusted.
    """
    file, arm, known = opened(urdf, description, tool, base, on_progress)
    rows = read_measurements(table, arm, known)
    return identified(arm, data_set(rows, known, arm), file, on_progress)


def opened(
    urdf: AnyPath,
    description: AnyPath | Description | None,
    tool: str | None,
    base: str | None,
    on_progress: Progress,
) -> tuple[UrdfFile, Arm, Description]:
    """What `calibrate_arm` is given, read."""
    file = UrdfFile.read(urdf)
    arm = arm_of(file.content, file.path, tool, base)
    if description is not None and not isinstance(description, Description):
        description = read_description(description)
    on_progress(file.origin)
    return file, arm, description or Description()


def identified(
    arm: Arm, data: DataSet, urdf: UrdfFile | None = None, on_progress: Progress = silent
) -> Calibrated:
    """Identify the errors of an arm, and validate them. Raises as `calibrate_arm`."""
    moving = counted(len(arm.joints), "joint")
    on_progress(f"{len(data)} rows of {moving}, from {arm.base} to {arm.tool}")
    observations, known, offset = data.observations, data.known, None
    if data.nominal is not None:
        stand = None if known.instrument is None else np.linalg.inv(known.instrument)
        offset = check_nominal(arm, observations.joints, data.nominal, stand, known.target)
    on_progress("initial estimate of instrument and target")
    frames = known.stated_in(frames_of(arm, data))
    if observations.optics is not None:
        frames = frames.with_optics(observations.optics)
        covariance = returning(ErrorModel(arm, OFFSETS, frames), observations)
        observations = observations.with_noise(covariance)
        data = replace(data, observations=observations)
    check_distances(arm, data, frames)
    mistake = mistake_in(arm, observations, frames)
    try:
        validation = validate(arm, observations, frames, on_progress)
    except Untrustworthy as error:
        found = without_shift(error.faults, mistake)
        reasons = [fault_in_words(fault, data, frames) for fault in found]
        reasons += [f"likely: {mistake}"] if mistake else []
        reasons += data.doubts
        ranges = data.rows_of_sights if len(data.tables) > 1 else []
        raise Untrustworthy("; ".join([str(error), *reasons, *ranges])) from None
    sizes = scales(arm, observations[validation.counted], frames)
    named = dict(zip(data.scaled, sizes, strict=True))
    return Calibrated(urdf, data, frames, validation, named, mistake, offset)
