"""What a recording tells: a training watched from outside, and how the arm moves around it."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from recalib.damaged.plant import Plant
from recalib.interfaces import Learner
from recalib.learners.hierarchical import HierarchicalLearner
from recalib.nominal.controller import Controller
from recalib.nominal.poses import POSITION, orientation_error, position_error
from recalib.study.experiments.poses import ResultPoses, train_for_results
from recalib.study.recording.acts import ACT, FRAMES_A_SECOND, LEARNING, POSES
from recalib.study.recording.cells import Cells, CellWatch
from recalib.training import History

REPEATED = 10  # measurements of each shown pose, to see how they scatter


@dataclass(frozen=True)
class Watched:
    """One training of one learner, seen at each of its measurements.

    Attributes:
        history: the errors on all test poses.
        desired: (pose, 4, 4) those of the test poses that are shown.
        achieved: (measurement, pose, 4, 4) where the real arm lands instead.
        angles: (measurement, pose, joint) rad, what the controller commands the joints for them.
        misses, tilts: (measurement, pose) position errors in m and orientation errors in rad.
        scatter: (pose, repetition, 3) m by which measurements miss where the trained arm lands
            undisturbed.
        cells: those of the map; None for a learner that has none.
    """

    history: History
    desired: np.ndarray
    achieved: np.ndarray
    angles: np.ndarray
    misses: np.ndarray
    tilts: np.ndarray
    scatter: np.ndarray
    cells: Cells | None


def visiting_order(poses: np.ndarray) -> np.ndarray:
    """The poses (pose, 6) from the rim of the workspace inwards.

    The last one, where the arm waits, is seen best.
    """
    return poses[np.argsort(-np.linalg.norm(poses[:, POSITION], axis=-1))]


def watch(
    controller: Controller,
    plant: Plant,
    learner: Learner,
    poses: ResultPoses,
    measure_at: Sequence[int],
) -> Watched:
    """Train a fresh learner of one run and watch it.

    Args:
        plant: one run of the controller's robot.
        poses: of one run; the first few of those to measure on are shown.
        measure_at: numbers of iterations after which to measure.
    """
    workspace, shown = controller.robot.workspace, visiting_order(poses.tests[0, :POSES])
    has_cells = isinstance(learner, HierarchicalLearner)
    cells = CellWatch(learner, workspace, poses.desired[0]) if has_cells else None
    commands = []

    def look(iteration: int, *_: float) -> None:
        commands.append(learner.command(shown[None])[0])
        if cells:
            cells.look(iteration)

    history = train_for_results(plant, learner, poses, measure_at, progress=look)
    goals, home = workspace.to_poses(shown), controller.robot.home
    targets = controller.targets(np.concatenate(commands)[None])
    angles = np.where(targets.executed[..., None], targets.angles, home)  # at home where refused
    achieved = plant.achieve_targets(targets)[0].reshape(len(commands), *goals.shape)
    repeated = plant.execute(np.repeat(commands[-1][None], REPEATED, axis=1)).achieved[0]
    measured = workspace.to_poses(repeated).reshape(len(shown), REPEATED, 4, 4)
    return Watched(
        history=history,
        desired=goals,
        achieved=achieved,
        angles=angles.reshape(len(commands), len(shown), -1),
        misses=position_error(achieved, goals),
        tilts=orientation_error(achieved, np.broadcast_to(goals, achieved.shape)),
        scatter=(measured - achieved[-1][:, None])[..., :3, 3],
        cells=cells and cells.seen(),
    )


@dataclass(frozen=True)
class Motion:
    """Three acts: visit the shown poses, wait at the last of them while learning, visit them again.

    Attributes:
        times: (frame,) seconds from the start, in the first and the third act.
        angles: (frame, joint) rad that the controller believes in.
        departures, arrivals: (2, pose) seconds at which a move to a pose starts and ends, in the
            acts one and three.
        learning: (measurement,) seconds of the second act at which the measurements are shown.
        end: seconds at which the third act ends.
    """

    times: np.ndarray
    angles: np.ndarray
    departures: np.ndarray
    arrivals: np.ndarray
    learning: np.ndarray
    end: float


def move(watched: Watched, home: np.ndarray, most: int) -> Motion:
    """The motion that shows a training, from the home angles (joint,) [rad].

    Args:
        most: moves of the longest training that is shown beside it: all share one clock.
    """
    before, after = watched.angles[0], watched.angles[-1]
    visit = ACT / len(before)
    starts = np.array([0, ACT + LEARNING])
    departures = starts[:, None] + np.arange(len(before)) * visit
    clock = np.arange(round(visit * FRAMES_A_SECOND)) / FRAMES_A_SECOND
    done = np.minimum(clock / (visit / 2), 1)
    return Motion(
        times=(departures[:, :, None] + clock).ravel(),
        angles=np.concatenate([_visits(home, before, done), _visits(after[-1], after, done)]),
        departures=departures,
        arrivals=departures + visit / 2,
        learning=ACT + LEARNING * watched.history.moves / max(most, 1),
        end=2 * ACT + LEARNING,
    )


def _visits(start: np.ndarray, stops: np.ndarray, done: np.ndarray) -> np.ndarray:
    """Angles (stop x frame, 6) of smooth moves from `start` (6,) from stop to stop (stop, 6).

    Args:
        done: (frame,) of each way, in [0, 1], if the arm moved evenly.
    """
    eased = (done**2 * (3 - 2 * done))[:, None]  # at rest at both ends
    starts = np.concatenate([start[None], stops[:-1]])[:, None]
    return (starts + eased * (stops[:, None] - starts)).reshape(-1, stops.shape[-1])
