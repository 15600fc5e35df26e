"""Calibration: from measurements to a calibrated arm and its cross-validated errors."""

from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from recalib.arrays import array_of, check_rotations, check_size
from recalib.errors import InvalidSetting, check_function
from recalib.files.outputs import AnyPath
from recalib.files.quantities import LENGTH, TIME
from recalib.identification.checks.diagnostics import Untrustworthy
from recalib.identification.checks.scales import returning, scales
from recalib.identification.model.error_model import OFFSETS, ErrorModel
from recalib.identification.validation import validate
from recalib.laboratory.data_set import DataSet, data_set
from recalib.laboratory.plausibility.knowledge import check_distances, frames_of, mistake_in
from recalib.laboratory.plausibility.mistakes import check_nominal
from recalib.laboratory.report.doubts import fault_in_words, gain_in_words
from recalib.laboratory.report.summary import summary
from recalib.laboratory.results import Results, without_shift
from recalib.laboratory.tables.columns import SOCKETS, TARGETS, TIMES, Columns
from recalib.laboratory.tables.description import Description, distances_of, read_description
from recalib.laboratory.tables.measurements import Measurements, check_measured, read_measurements
from recalib.laboratory.tables.table import Table
from recalib.nominal.arms import arm_of
from recalib.nominal.descriptions import UrdfFile
from recalib.nominal.kinematics import Arm
from recalib.spelling import counted

Progress = Callable[[str], None]
ARRAYS = Path("the arrays")  # the name of measurements without a file in messages


class Calibrated(Results):
    """A calibrated arm: `summary()`, `predict(joints)`, `correct(poses)`."""

    def summary(self) -> str:
        """The printed summary: errors before and after, and the identified arm."""
        return summary(self)


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
    on_progress: Progress = lambda line: None,
) -> Calibrated:
    """Identify the errors of an arm from arrays of measurements.

    Args:
        arm: the nominal arm.
        joints: (n, joints) rad, or m for sliding joints, as the controller reported them; without
            joints that follow others.
        measured: poses (n, 4, 4) or positions (n, 3) [m] of a target on the tool, in the frame of
            the instrument.
        targets: (n,) names of the targets, if there are several.
        sockets: (n,) instead of `measured`: names of the sockets that held a ball on the tool.
        distances: m between the centres of two sockets, by their names.
        times: (n,) s, when each row was measured; never decreasing.
        instrument: (4, 4) m in the arm's base, if known; otherwise identified.
        target: (4, 4) m in the tool link's frame, if known; otherwise identified.
        on_progress: called with a line of text for each step.

    Raises InvalidSetting if an array has another shape; otherwise like `calibrate_arm`.
    """
    if not isinstance(arm, Arm):
        raise InvalidSetting("arm", type(arm).__name__, "an Arm, as load_arm returns")
    moving = arm.coupling.given("joints", joints, ("n",))
    count, poses, columns = len(moving), None, {}
    if measured is not None:
        poses = array_of("measured", measured, (count, 3), (count, 4, 4))
        check_size("measured", poses if poses.ndim == 2 else poses[:, :3, 3], LENGTH)
        if poses.ndim == 3:
            check_rotations("measured", poses)
    if times is not None:
        columns[TIMES.name] = array_of("times", times, (count,))
        check_size("times", columns[TIMES.name], TIME)
    for kind, labels in ((TARGETS, targets), (SOCKETS, sockets)):
        if labels is not None:
            columns[kind.name] = _names(kind, labels, count)
    if distances is not None and not isinstance(distances, Mapping):
        valid = "lengths [m] by the names of two sockets"
        raise InvalidSetting("distances", type(distances).__name__, valid)
    for pair, length in (distances or {}).items():
        name = f"distances[{pair!r}]"
        check_size(name, array_of(name, length, ()), LENGTH)
        if length <= 0:
            raise InvalidSetting(name, length, "more than zero")
    pairs = distances_of((pair, float(length)) for pair, length in (distances or {}).items())
    check_function("on_progress", on_progress)
    frames = _frame("instrument", instrument), _frame("target", target)
    rows = Measurements(ARRAYS, moving, poses, columns)
    known = Description({}, *frames, pairs)
    check_measured(rows)
    return identified(arm, data_set(rows, known, arm), on_progress=on_progress)


def _frame(name: str, given: ArrayLike | None) -> np.ndarray | None:
    if given is None:
        return None
    pose = array_of(name, given, (4, 4))
    check_rotations(name, pose)
    check_size(name, pose[:3, 3], LENGTH)
    return pose


def _names(kind: Columns, labels: Any, count: int) -> np.ndarray:
    """Names (n,), checked like a column of a table. Raises InvalidSetting and InvalidFile."""
    try:
        given = [] if isinstance(labels, str) else [*labels]
    except TypeError:  # a number
        given = []
    if len(given) != count or not all(isinstance(label, Hashable) for label in given):
        raise InvalidSetting(kind.name, labels, f"{count} names")
    heading = kind.headings[0]
    cells = ["" if label is None or label != label else str(label) for label in given]
    return Table(ARRAYS, {heading: ""}, {heading: cells}, {}).read([kind])[kind.name]


def calibrate_arm(
    urdf: AnyPath,
    table: AnyPath,
    description: AnyPath | Description | None = None,
    tool: str | None = None,
    base: str | None = None,
    on_progress: Progress = lambda line: None,
) -> Calibrated:
    """Identify the errors of an arm from a table of measurements.

    Args:
        urdf: a path, or a name that `recalib.nominal.arms.find_urdf` knows.
        table: of measurements; see docs/own_arm.md.
        description: frames, distances and columns that the table cannot express.
        tool, base: link names; needed only if the arm has several ends.
        on_progress: called with a line of text for each step.

    Raises RecalibError: an unusable arm, table or description; nominal positions of another arm;
    frames that are not identifiable, or contradict the description; a fit that cannot be trusted.
    """
    check_function("on_progress", on_progress)
    file, arm, known = opened(urdf, description, tool, base)
    on_progress(file.origin)
    rows = read_measurements(table, arm, known)
    return identified(arm, data_set(rows, known, arm), file, on_progress)


def opened(
    urdf: AnyPath, description: AnyPath | Description | None, tool: str | None, base: str | None
) -> tuple[UrdfFile, Arm, Description]:
    """Read the inputs of `calibrate_arm`: the URDF file, its arm, and the description."""
    file = UrdfFile.read(urdf)
    arm = arm_of(file.content, file.path, tool, base)
    if description is not None and not isinstance(description, Description):
        description = read_description(description)
    return file, arm, description or Description()


def identified(
    arm: Arm, data: DataSet, urdf: UrdfFile | None = None, on_progress: Progress = lambda line: None
) -> Calibrated:
    """Identify the errors of an arm, and validate them. Raises like `calibrate_arm`."""
    moving = counted(len(arm.joints), "joint")
    on_progress(f"{len(data)} rows of {moving}, from {arm.base} to {arm.tool}")
    observations, known, offset = data.observations, data.known, None
    if data.nominal is not None:
        base = None if known.instrument is None else np.linalg.inv(known.instrument)
        offset = check_nominal(arm, observations.joints, data.nominal, base, known.target)
    on_progress("initial estimate of instrument and target")
    frames = frames_of(arm, data)
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
        if mistake:
            reasons.append(f"likely: {mistake}")
        elif error.gain:
            reasons.append(gain_in_words(error.gain, arm))
        reasons += data.doubts
        ranges = data.rows_of_sights if len(data.tables) > 1 else []
        raise Untrustworthy("; ".join([str(error), *reasons, *ranges])) from None
    sizes = scales(arm, observations[validation.counted], frames)
    named = dict(zip(data.scaled, sizes, strict=True))
    return Calibrated(urdf, data, frames, validation, named, mistake, offset)
