"""A training watched from outside: where the arm goes, and what the cells of its map learn."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from recalib.damaged.plant import Plant
from recalib.learners.hierarchical import HierarchicalLearner
from recalib.loop.interfaces import Learner
from recalib.loop.training import History
from recalib.nominal.controller import Controller
from recalib.nominal.poses import POSITION
from replication.recording.phases import POSES
from replication.training.poses import ResultPoses, SearchPoses, train_for_results

REPEATED = 10  # measurements of each shown pose, to see how they scatter


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
        scatter: (pose, repetition, 3) m by which measurements miss where the trained arm lands
            undisturbed.
        cells: those of the map; None for a learner that has none.
    """

    history: History
    desired: np.ndarray
    achieved: np.ndarray
    angles: np.ndarray
    scatter: np.ndarray
    cells: MapCells | None


def visiting_order(poses: np.ndarray) -> np.ndarray:
    """The poses (pose, 6) from the rim of the workspace inwards.

    The last one, where the arm waits, is seen best.
    """
    return poses[np.argsort(-np.linalg.norm(poses[:, POSITION], axis=-1))]


def watch(
    controller: Controller,
    plant: Plant,
    learner: Learner,
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
    maps = learner if isinstance(learner, HierarchicalLearner) else None

    def on_progress(iteration: int, *_: float) -> None:
        commands.append(learner.command(shown[None])[0])
        if maps:
            thetas.append(maps.maps.cells.theta[0, 0, ..., POSITION].copy())
            weights.append(_neighbourhood(maps, poses.desired[0], iteration))

    history = train_for_results(plant, learner, poses, measure_at, progress=on_progress)
    goals, home = workspace.to_poses(shown), controller.robot.home
    targets = controller.targets(np.concatenate(commands)[None])
    angles = np.where(targets.executed[..., None], targets.angles, home)  # at home where refused
    achieved = plant.achieve_targets(targets)[0].reshape(len(commands), *goals.shape)
    repeated = plant.execute(np.repeat(commands[-1][None], REPEATED, axis=1)).achieved[0]
    measured = workspace.to_poses(repeated).reshape(len(shown), REPEATED, 4, 4)
    cells = None
    if maps:
        half_ranges = workspace.half_ranges[POSITION]
        cells = MapCells(
            centres=workspace.centre[:3, 3] + maps.maps.nets.w_k * half_ranges,
            weights=np.stack(weights),
            corrections=(np.stack(thetas) - thetas[0]).mean(axis=2) * half_ranges,
        )
    return Watched(
        history=history,
        desired=goals,
        achieved=achieved,
        angles=angles.reshape(len(commands), len(shown), -1),
        scatter=(measured - achieved[-1][:, None])[..., :3, 3],
        cells=cells,
    )


def _neighbourhood(learner: HierarchicalLearner, desired: np.ndarray, iteration: int) -> np.ndarray:
    """g_k (cell,) in the iteration before; zero where there was none."""
    nets, last = learner.maps.nets, iteration - 1
    if iteration == 0:
        return np.zeros(len(nets.w_k))
    widths = learner.widths(last / len(desired))[:, 0].T
    return nets.neighbourhood(*nets.winner(desired[[last]]), *widths)[0][0]
