"""A training watched from outside: where the arm goes, and what the cells of its map learn."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from recalib.damaged.plant import Plant
from recalib.learners.hierarchical import HierarchicalLearner
from recalib.loop.training import History
from recalib.nominal.controller import Controller
from recalib.nominal.poses import POSITION
from replication.recording.phases import POSES
from replication.training.poses import ResultPoses, SearchPoses, train_for_results


@dataclass(frozen=True)
class MapCells:
    """The supernet's cells of the map that gives positions.

    Attributes:
        centres: (cell, 3) m in the base frame.
        weights: (measurement, cell) of the neighbourhood g_k about the last winner, in [0, 1]; zero
            before the first.
        corrections: (measurement, cell, 3) m along the base's axes, by which learning moved the
            position commands of a cell, the mean over its subnet.
    """

    centres: np.ndarray
    weights: np.ndarray
    corrections: np.ndarray


@dataclass(frozen=True)
class Watched:
    """One training of one learner, with what was there at each of its measurements.

    Attributes:
        history: the errors on all test poses.
        desired: (pose, 4, 4) those of the test poses that are shown.
        achieved: (measurement, pose, 4, 4) where the real arm lands instead.
        angles: (measurement, pose, joint) rad, what the controller commands the joints for them.
        cells: those of the map.
    """

    history: History
    desired: np.ndarray
    achieved: np.ndarray
    angles: np.ndarray
    cells: MapCells


def visiting_order(poses: np.ndarray) -> np.ndarray:
    """The poses (pose, 6) from the rim of the workspace inwards.

    The last one, where the arm waits, is seen best.
    """
    return poses[np.argsort(-np.linalg.norm(poses[:, POSITION], axis=-1))]


def watch(
    controller: Controller,
    plant: Plant,
    learner: HierarchicalLearner,
    poses: ResultPoses | SearchPoses,
    measure_at: Sequence[int],
) -> Watched:
    """Train a fresh learner of one run and watch it.

    Args:
        plant: one run of the controller's robot.
        poses: of one run; the first few of those to measure on are shown.
        measure_at: numbers of iterations after which to measure, from 0 on.
    """
    workspace, shown = controller.robot.workspace, visiting_order(poses.tests[0, :POSES])
    commands, thetas, weights = [], [], []

    def on_progress(iteration: int, *_: float) -> None:
        commands.append(learner.command(shown[None])[0])
        thetas.append(learner.cells.theta[0, 0, ..., POSITION].copy())
        weights.append(_neighbourhood(learner, poses.desired[0], iteration))

    history = train_for_results(plant, learner, poses, measure_at, progress=on_progress)
    goals, home = workspace.to_poses(shown), controller.robot.home
    targets = controller.targets(np.concatenate(commands)[None])
    angles = np.where(targets.executed[..., None], targets.angles, home)  # at home where refused
    achieved = plant.achieve_targets(targets)[0].reshape(len(commands), *goals.shape)
    half_ranges = workspace.half_ranges[POSITION]
    cells = MapCells(
        centres=workspace.centre[:3, 3] + learner.nets.w_k * half_ranges,
        weights=np.stack(weights),
        corrections=(np.stack(thetas) - thetas[0]).mean(axis=2) * half_ranges,
    )
    return Watched(
        history=history,
        desired=goals,
        achieved=achieved,
        angles=angles.reshape(len(commands), len(shown), -1),
        cells=cells,
    )


def _neighbourhood(learner: HierarchicalLearner, desired: np.ndarray, iteration: int) -> np.ndarray:
    """g_k (cell,) in the iteration before; zero where there was none."""
    nets, last = learner.nets, iteration - 1
    if iteration == 0:
        return np.zeros(len(nets.w_k))
    widths = learner.widths(last / len(desired))[:, 0].T
    return nets.neighbourhood(*nets.winner(desired[[last]]), *widths)[0][0]
