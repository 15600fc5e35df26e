"""A training with additional data for a recording: the arm's motion, and the state of cells."""

from dataclasses import dataclass

import numpy as np

from recalib.learners.hierarchical import HierarchicalLearner
from recalib.loop.training import History
from recalib.nominal.workspace import POSITION
from replication.config.study import Study
from replication.recording.phases import POSES
from replication.scenarios.plants import Resolved
from replication.training.plan import leading
from replication.training.poses import Stream, train_for_results
from replication.training.tuned import Tuned


@dataclass(frozen=True)
class Watched:
    """One training of one learner, with data at each of its measurements."""

    history: History  # the errors on all test poses
    desired: np.ndarray  # (pose, 4, 4) the shown test poses
    achieved: np.ndarray  # (measurement, pose, 4, 4) poses that the real arm achieves
    # (measurement, pose, joint) rad, joint angles that the controller chooses
    angles: np.ndarray
    # (cell, 3) m in the base frame, centres of the supernet of the position map
    centres: np.ndarray
    # (measurement, cell) in [0, 1], g_k about the last winner; zero before the first iteration
    weights: np.ndarray
    # (measurement, cell, 3) m along the base's axes, learned change of a cell's position commands,
    # the mean over its subnet
    corrections: np.ndarray


def visiting_order(poses: np.ndarray) -> np.ndarray:
    """The poses (pose, 6) from the rim of the workspace inwards.

    The arm waits at the last pose, so it should be the most visible one.
    """
    return poses[np.argsort(-np.linalg.norm(poses[:, POSITION], axis=-1))]


def watch(study: Study, resolved: Resolved, tuned: Tuned, seed: int) -> Watched:
    """Train the learner of Figure 1 in a scenario with a seed, and collect data for a recording.

    The first few test poses are shown.
    """
    (name, iterations, _), controller = leading(study), resolved.controller()
    learner, tests = tuned.learner(name, iterations, 1), study.training.tests
    plant = resolved.plant(controller, study.seed, [seed])
    poses = Stream.SCENARIO.draw(study.seed, [seed], iterations, tests, scenario=resolved.scenario)
    workspace, shown = controller.robot.workspace, visiting_order(poses.tests[0, :POSES])
    commands, thetas, weights = [], [], []

    def on_progress(iteration: int, *_: float) -> None:
        commands.append(learner.command(shown[None])[0])
        thetas.append(learner.cells.theta[0, 0, ..., POSITION].copy())
        weights.append(_neighbourhood(learner, poses.desired[0], iteration))

    measure_at = study.training.during(iterations)
    history = train_for_results(plant, learner, poses, measure_at, progress=on_progress)
    goals, home = workspace.to_poses(shown), controller.robot.home
    targets = controller.targets(np.concatenate(commands)[None])
    angles = np.where(targets.executed[..., None], targets.angles, home)  # home if refused
    half_ranges = workspace.half_ranges[POSITION]
    return Watched(
        history=history,
        desired=goals,
        achieved=plant.achieve_targets(targets)[0].reshape(len(commands), *goals.shape),
        angles=angles.reshape(len(commands), len(shown), -1),
        centres=workspace.centre[:3, 3] + learner.nets.w_k * half_ranges,
        weights=np.stack(weights),
        corrections=(np.stack(thetas) - thetas[0]).mean(axis=2) * half_ranges,
    )


def _neighbourhood(learner: HierarchicalLearner, desired: np.ndarray, iteration: int) -> np.ndarray:
    """g_k (cell,) in the previous iteration; zero if there was none."""
    nets, last = learner.nets, iteration - 1
    if iteration == 0:
        return np.zeros(len(nets.w_k))
    widths = learner.widths(last / len(desired))[:, 0].T
    return nets.neighbourhood(*nets.winner(desired[[last]]), *widths)[0][0]
