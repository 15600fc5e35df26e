"""The trial loop: a learner practises on one set of poses and is evaluated on another.

After training, `corrected` returns its commands.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from recalib.arrays import array_of
from recalib.errors import InvalidSetting, check_function, check_kind
from recalib.loop.interfaces import Commandable, Learner
from recalib.nominal.workspace import Workspace, pose_errors

SUMMARIES: Mapping[str, Callable[[np.ndarray], np.ndarray]] = {
    "": lambda errors: errors.mean(axis=-1),
    "_p95": lambda errors: np.percentile(errors, 95, axis=-1),
    "_max": lambda errors: errors.max(axis=-1),
}


@dataclass(frozen=True)
class History:
    """Errors by iteration; without the run axis if a single robot was trained.

    Attributes:
        iterations, moves: (measurement,) their numbers in each run before each measurement.
        refused: (run, measurement) number of refused moves before each measurement.
        position: (run, measurement, summary) mean, 95th percentile and maximum of the position
            errors in m.
        orientation: the same of the orientation errors in rad.
    """

    iterations: np.ndarray
    moves: np.ndarray
    refused: np.ndarray
    position: np.ndarray
    orientation: np.ndarray

    @property
    def position_error(self) -> np.ndarray:
        """Mean position errors (run, measurement) in m."""
        return self.position[..., 0]

    @property
    def orientation_error(self) -> np.ndarray:
        """Mean orientation errors (run, measurement) in rad."""
        return self.orientation[..., 0]

    def of_run(self, run: int) -> Self:
        """The history of one run."""
        parts = {name: getattr(self, name)[run] for name in ("refused", "position", "orientation")}
        return replace(self, **parts)

    def columns(self) -> dict[str, np.ndarray]:
        """Columns of a table with a row for each run and measurement; errors in cm and degrees."""
        runs = self.refused.size // len(self.iterations)
        table = {
            "run": np.repeat(np.arange(runs), len(self.iterations)),
            "iteration": np.tile(self.iterations, runs),
            "moves": np.tile(self.moves, runs),
            "refused": self.refused.ravel(),
        }
        for index, suffix in enumerate(SUMMARIES):
            table[f"position_error{suffix}_cm"] = 100 * self.position[..., index].ravel()
            table[f"orientation_error{suffix}_deg"] = np.degrees(
                self.orientation[..., index].ravel()
            )
        return table


def measure(
    plant: Commandable, learner: Learner, tests: np.ndarray, error: str = "norm"
) -> tuple[np.ndarray, np.ndarray]:
    """Position [m] and orientation errors [rad], each (run, summary), at poses (run, pose, 6).

    The learner does not learn from these moves, and they are not counted. For `error`, see
    `recalib.nominal.workspace.pose_errors`.
    """
    achieved, _ = plant.achieve(learner.command(tests))
    errors = pose_errors(plant.workspace, achieved, plant.workspace.to_poses(tests), error)
    position, orientation = (
        np.stack([summary(values) for summary in SUMMARIES.values()], axis=-1) for values in errors
    )
    return position, orientation


def train(
    plant: Commandable,
    learner: Learner,
    desired: np.ndarray,
    tests: np.ndarray,
    measure_at: Iterable[int],
    progress: Callable[[int, float, float], None] = lambda *_: None,
    error: str = "norm",
) -> History:
    """Train a learner and return the history of its errors.

    Args:
        plant: the robots.
        learner: the learner that commands them.
        desired: (run, iteration, 6) poses to learn from; for one robot, (iteration, 6).
        tests: (run, pose, 6) poses to measure on; for one robot, (pose, 6).
        measure_at: numbers of iterations after which to measure errors, in any order; 0 is before
            the first iteration.
        progress: called after each measurement with the iteration and the mean errors over runs in
            cm and degrees.
        error: definition of a pose's errors; see `recalib.nominal.workspace.pose_errors`.

    Raises InvalidSetting for arguments of other types, poses of other shapes, no test poses, no
    measurements, or a measurement after more iterations than there are.
    """
    check_kind("plant", plant, Commandable)
    check_kind("learner", learner, Learner)
    check_function("progress", progress)
    desired = array_of("desired", desired, ("n", "n", 6), ("n", 6))
    tests = array_of("tests", tests, (*desired.shape[:-2], "n", 6))
    if not tests.size:
        raise InvalidSetting("tests", f"of shape {tests.shape}", "at least one pose")
    if desired.ndim == 2:
        poses = desired[None], tests[None]
        return train(plant, learner, *poses, measure_at, progress, error).of_run(0)
    check_kind("measure_at", measure_at, Iterable)
    iterations, given = desired.shape[1], array_of("measure_at", [*measure_at], ("n",)).tolist()
    if not given or not all(time in range(iterations + 1) for time in given):
        raise InvalidSetting("measure_at", given, f"numbers from 0 to {iterations}, at least one")
    times = sorted({*map(int, given)})
    position, orientation, moves, refused = [], [], [], []
    for iteration in range(iterations + 1):
        if iteration in times:
            errors = measure(plant, learner, tests, error)
            position.append(errors[0])
            orientation.append(errors[1])
            moves.append(plant.moves)
            refused.append(np.broadcast_to(plant.refused, len(desired)))
            progress(iteration, 100 * errors[0][:, 0].mean(), np.degrees(errors[1][:, 0].mean()))
        if iteration < iterations:
            learner.learn(desired[:, iteration], plant.execute, iteration / iterations)
    by_run = (np.stack(measured, axis=1) for measured in (refused, position, orientation))
    return History(np.array(times), np.array(moves), *by_run)


def corrected(learner: Learner, workspace: Workspace, poses: np.ndarray) -> np.ndarray:
    """Pose commands (n, 4, 4) [m] that take the tool of one robot to desired poses (n, 4, 4) [m].

    Args:
        learner: a learner that was trained on this robot, in one run.
        workspace: the robot's workspace.

    Raises InvalidSetting for arguments of other shapes or types.
    """
    check_kind("learner", learner, Learner)
    check_kind("workspace", workspace, Workspace)
    return workspace.to_poses(learner.command(workspace.to_coordinates(poses)[None])[0])
