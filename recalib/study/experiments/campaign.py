"""Trainings of one learner, in the chunks that the workflow makes."""

import sys
from pathlib import Path

import numpy as np

from recalib.learners.hierarchical import HierarchicalLearner
from recalib.nominal.robots import Robot
from recalib.study import jobs
from recalib.study.experiments.poses import Stream, train_for_results
from recalib.study.experiments.settings import build_tuned
from recalib.study.plants import Resolved
from recalib.study.progress import progress_bar
from recalib.training import measuring_grid


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
    tests = job.measuring.tests
    poses = Stream.SCENARIO.draw(job.seed, seeds, iterations, tests, scenario=job.scenario)
    name = f"{Path(sample).stem} on {job.scenario}"
    with progress_bar(name, iterations) as progress:
        history = train_for_results(
            plant,
            learner,
            poses,
            measured_at(job.measuring, iterations) if job.throughout else [0, iterations],
            progress=progress,
        )
    if refused := history.refused[:, -1].sum():
        print(f"{name}: the controller refused {refused} moves", file=sys.stderr)
    columns = history.columns()
    run = columns.pop("run")
    by_run = {"search": searches[run], "seed": seeds[run]}
    return by_run | columns, learner, controller.robot
