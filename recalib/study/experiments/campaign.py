"""Trainings of one learner: their poses, and the chunks that the workflow makes."""

import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from recalib.learners.hierarchical import HierarchicalLearner
from recalib.nominal.robots import Robot
from recalib.randomness import generator
from recalib.study import jobs
from recalib.study.experiments.settings import build_tuned
from recalib.study.plants import Resolved
from recalib.study.progress import progress_bar
from recalib.training import measuring_grid, train


def desired_poses(
    seed: int, scope: str, runs: Sequence[int], iterations: int, order: str = "random"
) -> np.ndarray:
    """Poses to learn from, (run, iteration, 6): the same for every learner.

    Fewer iterations see the first of them.

    Args:
        scope: a scenario, or a word for another purpose.
        order: "random": each by itself; "even": a scrambled Sobol sequence.
    """
    draw = {"random": _independent, "even": _spread_evenly}[order]
    return np.stack([draw(generator(seed, scope, run, "desired"), iterations) for run in runs])


def _independent(random: np.random.Generator, count: int) -> np.ndarray:
    return random.uniform(-1, 1, (count, 6))


def _spread_evenly(random: np.random.Generator, count: int) -> np.ndarray:
    from scipy.stats import qmc  # a third of a second, which only this order needs

    return 2 * qmc.Sobol(6, rng=random).random_base2((count - 1).bit_length())[:count] - 1


def test_poses(seed: int, scope: str, runs: Sequence[int], count: int) -> np.ndarray:
    """Poses to measure on, (run, pose, 6), never used for learning."""
    return np.stack(
        [generator(seed, scope, run, "tests").uniform(-1, 1, (count, 6)) for run in runs]
    )


def measured_at(measuring: jobs.Measuring, iterations: int) -> list[int]:
    """The iterations after which a training is measured throughout."""
    return measuring_grid(iterations, measuring.every, measuring.evenly, measuring.measurements)


def train_seeds(
    job: jobs.Training, scenario: str | Path, sample: str | Path
) -> tuple[dict[str, np.ndarray], HierarchicalLearner, Robot]:
    """Train some seeds of a learner on a scenario: the winner of each search, each with its seeds.

    The poses of a seed are the same for every learner.

    Args:
        scenario: file of the scenario as resolved.
        sample: file of the searches for this training.

    Returns the history by its columns, a row for each run and measurement, the trained learner,
    and the robot as its controller believes in it.
    """
    resolved, iterations = Resolved.read(scenario), job.learner.iterations
    controller = resolved.controller()
    seeds = np.arange(job.first, job.last)
    searches = 1 + seeds // job.seeds
    plant = resolved.plant(controller, job.seed, seeds)
    learner = build_tuned(job.learner, sample, searches)
    name = f"{Path(sample).stem} on {job.scenario}"
    with progress_bar(name, iterations) as progress:
        history = train(
            plant,
            learner,
            desired_poses(job.seed, job.scenario, seeds, iterations),
            test_poses(job.seed, job.scenario, seeds, job.measuring.tests),
            measured_at(job.measuring, iterations) if job.throughout else [0, iterations],
            progress,
        )
    if refused := history.refused[:, -1].sum():
        print(f"{name}: the controller refused {refused} moves", file=sys.stderr)
    columns = history.columns()
    run = columns.pop("run")
    by_run = {"search": searches[run], "seed": seeds[run]}
    return by_run | columns, learner, controller.robot
