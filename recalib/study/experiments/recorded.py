"""Learning from recordings of a real arm: a UR5 whose tool was followed by a laser tracker, position only.

The recording is a table (CSV) with a row for each pose: joint_1 to joint_6 [deg] as commanded, x_t, y_t, z_t [mm] where the
nominal kinematics put the tool, and x_dif, y_dif, z_dif [mm] by how much it was measured to be beside that. The joints' zero
is that of the URDF; the manufacturer's base stands turned by half a turn about the vertical axis of the URDF's.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from os import PathLike

import numpy as np
import pandas as pd
import pinocchio as pin

from recalib.errors import InvalidSetting, UnknownName
from recalib.identification.calibration import Calibration, calibrate
from recalib.identification.error_model import JOINT_ERRORS, JOINT_WAVES, OFFSETS, ErrorModel
from recalib.identification.estimation import identify
from recalib.learners.gaussian_process import GaussianProcessLearner
from recalib.learners.polynomial import PolynomialLearner
from recalib.nominal.kinematics import Arm, tool_frame
from recalib.nominal.poses import POSITION, Workspace
from recalib.nominal.robots import Robot

JOINTS = [f"joint_{number}" for number in range(1, 7)]
NOMINAL, MISSED = (["x_t", "y_t", "z_t"], ["x_dif", "y_dif", "z_dif"])
TO_URDF_BASE = np.array([-1.0, -1.0, 1.0])
TOOL_POINT = 0.0, 0.00007, 0.031  # m, in the flange's frame: where the tracker's target was


@dataclass(frozen=True)
class Recording:
    """Recorded poses, in the conventions of the URDF.

    Attributes:
        angles: (n, 6) rad that were commanded.
        nominal: (n, 3) m in the base frame, where the recording says that the tool should have been.
        measured: (n, 3) m in the base frame, where it was.
    """

    angles: np.ndarray
    nominal: np.ndarray
    measured: np.ndarray

    def __len__(self) -> int:
        return len(self.angles)

    def __getitem__(self, rows) -> "Recording":
        return Recording(self.angles[rows], self.nominal[rows], self.measured[rows])


def read_recording(path: str | PathLike) -> Recording:
    """The recording in the table at `path`.

    Raises InvalidSetting where a column is missing or holds anything but finite numbers.
    """
    table = pd.read_csv(path)
    for column in (*JOINTS, *NOMINAL, *MISSED):
        if (
            column not in table
            or not np.isfinite(pd.to_numeric(table[column], errors="coerce")).all()
        ):
            raise InvalidSetting(
                f"column of {path}", column, "there, with a finite number in every row"
            )
    nominal = table[NOMINAL].to_numpy() * 1e-3 * TO_URDF_BASE
    missed = table[MISSED].to_numpy() * 1e-3 * TO_URDF_BASE
    return Recording(np.radians(table[JOINTS].to_numpy()), nominal, nominal + missed)


def with_tool_point(robot: Robot, point: tuple[float, float, float] = TOOL_POINT) -> Robot:
    """The robot with its tool at a point of the flange, (3,) m in the tool's frame; its workspace moves along."""
    model = pin.Model(robot.arm.model)
    tool = model.frames[tool_frame(model, robot.arm.tool)]
    tool.placement = tool.placement * pin.SE3(np.eye(3), np.array(point))
    arm = Arm(model, robot.arm.tool)
    workspace = Workspace(arm.forward(robot.home[None])[0], robot.workspace.half_ranges)
    return replace(robot, arm=arm, workspace=workspace)


def calibrate_geometric(arm: Arm, recording: Recording) -> Calibration:
    """The geometry of the nominal arm, identified."""
    model = ErrorModel(arm, OFFSETS)
    return Calibration(model, identify(model, recording.angles, recording.measured))


def calibrate_hybrid(arm: Arm, recording: Recording) -> Calibration:
    """Geometry and as much else as the recording shows. Its `forward` makes it a twin of the arm, which a `Plant` takes."""
    return calibrate(
        arm, (OFFSETS, JOINT_ERRORS, JOINT_WAVES), recording.angles, recording.measured
    )


def _model_based(
    fit: Callable[[Arm, Recording], Calibration], arm: Arm, known: Recording, unknown: Recording
) -> np.ndarray:
    return unknown.measured - fit(arm, known).forward(unknown.angles)[:, :3, 3]


def _black_box(
    make: Callable[[int], PolynomialLearner | GaussianProcessLearner],
    arm: Arm,
    known: Recording,
    unknown: Recording,
) -> np.ndarray:
    """Asked for the pose that was measured, the learner should command the one that was."""
    commanded = arm.forward(known.angles)
    centre = commanded[
        np.linalg.norm(known.angles - np.median(known.angles, axis=0), axis=1).argmin()
    ]
    raw = Workspace(centre, np.ones(6)).to_coordinates(commanded)
    workspace = Workspace(centre, np.abs(raw).max(axis=0))
    learner = make(1)
    sent, achieved = _coordinates(arm, workspace, known)
    learner.observe(sent, achieved, np.ones(sent.shape[:2], dtype=bool))
    sent, achieved = _coordinates(arm, workspace, unknown)
    return (sent - learner.command(achieved))[0, :, POSITION] * workspace.half_ranges[POSITION]


def _coordinates(
    arm: Arm, workspace: Workspace, recording: Recording
) -> tuple[np.ndarray, np.ndarray]:
    """Coordinates (1, n, 6) commanded and achieved; the orientation, which was not measured, counts as commanded."""
    commanded = arm.forward(recording.angles)
    achieved = commanded.copy()
    achieved[:, :3, 3] = recording.measured
    return workspace.to_coordinates(commanded)[None], workspace.to_coordinates(achieved)[None]


# By name: from the nominal arm, a recording to learn from and one to be tested on, the errors left there (m, 3) [m].
LEARNERS: Mapping[str, Callable[[Arm, Recording, Recording], np.ndarray]] = {
    "uncorrected": lambda arm, known, unknown: unknown.measured - unknown.nominal,
    "affine": partial(_black_box, partial(PolynomialLearner, degree=1)),
    "quadratic": partial(_black_box, partial(PolynomialLearner, degree=2)),
    "gaussian_process": partial(_black_box, GaussianProcessLearner),
    "geometric": partial(_model_based, calibrate_geometric),
    "hybrid": partial(_model_based, calibrate_hybrid),
}


def remaining_errors(learner: str, arm: Arm, known: Recording, unknown: Recording) -> np.ndarray:
    """Distances (m,) [m] that the learner leaves at poses it has not learned from.

    Args:
        learner: one of `LEARNERS`.
        arm: the nominal arm, its tool at the point that was measured; see `with_tool_point`.
        known, unknown: what it learns from, and what it is tested on.

    Raises UnknownName.
    """
    if learner not in LEARNERS:
        raise UnknownName("learner from recordings", learner, LEARNERS)
    return np.linalg.norm(LEARNERS[learner](arm, known, unknown), axis=-1)
