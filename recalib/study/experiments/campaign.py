"""Trainings of one learner, in the chunks that the workflow makes."""

import sys
from pathlib import Path

import numpy as np

from recalib.learners.learned import save
from recalib.study.configuration.study import LearnerSettings, Measuring
from recalib.study.experiments.poses import Stream, train_for_results
from recalib.study.experiments.settings import build_tuned
from recalib.study.scenarios.plants import Resolved


def train_seeds(
    scenario: Path,
    sample: Path,
    learned: Path,
    rules: LearnerSettings,
    seeds: int,
    first: int,
    last: int,
    measuring: Measuring,
    throughout: bool,
    seed: int,
) -> dict[str, np.ndarray]:
    """Train some seeds of a learner on a scenario: the winner of each search, each with its seeds.

    The poses of a seed are the same for every learner.

    Args:
        learned: file for what they learn.
        seeds: of each search.
        first, last: the first of the training's seeds that are trained, and one past the last.
        throughout: whether on their way, too.

    Returns the history by its columns, a row for each run and measurement.
    """
    resolved, iterations = Resolved.read(scenario), rules.iterations
    controller, scope = resolved.controller(), resolved.scenario
    runs = range(first, last)
    searches = 1 + np.array(runs) // seeds
    plant = resolved.plant(controller, seed, runs)
    learner = build_tuned(rules, sample, searches)
    poses = Stream.SCENARIO.draw(seed, runs, iterations, measuring.tests, scenario=scope)
    measure_at = measuring.during(iterations) if throughout else [0, iterations]
    history = train_for_results(plant, learner, poses, measure_at)
    if refused := history.refused[:, -1].sum():
        name = f"{sample.stem} on {scope}"
        print(f"{name}: the controller refused {refused} moves", file=sys.stderr)
    save(learned, learner, controller.robot)
    columns = history.columns()
    run = columns.pop("run")
    return {"search": searches[run], "seed": first + run} | columns
