"""Trainings on other assignments of the paper's damage, each at several scales."""

from collections.abc import Iterator, Sequence
from contextlib import suppress
from itertools import chain, islice
from pathlib import Path

import pandas as pd

from recalib.damaged.damage import DamagedArm, apply
from recalib.damaged.plant import Plant
from recalib.errors import InvalidSetting
from recalib.nominal.robots import Robot
from recalib.numerics.randomness import generator
from replication.config.study import Study
from replication.config.switches import IMPROVED
from replication.scenarios.assignments import Ways
from replication.scenarios.plants import nominal_controller, nominal_of
from replication.training.measured import ERRORS
from replication.training.poses import Stream, train_for_results
from replication.training.tuned import Tuned


def feasible(
    robot: Robot, ways: Ways, order: Sequence[int], scales: Sequence[float]
) -> Iterator[list[DamagedArm]]:
    """Arms with assignments in this order, at all scales, if the links are long enough for all."""
    for damages in map(ways.__getitem__, order):
        with suppress(InvalidSetting):
            yield [apply(robot, [its.scaled(scale) for its in damages]) for scale in scales]


def train_ensemble(study: Study, settings: Sequence[Path]) -> pd.DataFrame:
    """Train the improved system on the ensemble's robots.

    Returns a row for each draw and scale, with both errors before and after learning.
    """
    nominal, plan = nominal_of(study, study.robot), study.experiments
    controller, scales = nominal_controller(nominal), plan.ensemble.scales
    robot, damage = controller.robot, study.paper_damage
    ways = Ways(nominal.robot.links, damage.shorten, robot.joints, damage.shift)
    order = generator(study.seed, "ensemble", "scaled").permutation(len(ways)).tolist()
    drawn = [*islice(feasible(robot, ways, order, scales), plan.ensemble.draws)]
    draws = [draw for draw in range(len(drawn)) for _ in scales]
    history = train_for_results(
        Plant(controller, [*chain.from_iterable(drawn)]),
        Tuned(study, settings).learner(IMPROVED, plan.iterations, len(draws)),
        Stream.ENSEMBLE.draw(study.seed, draws, plan.iterations, study.training.tests),
        [0, plan.iterations],
    )
    columns = history.columns()
    table = {
        f"{moment}_{error}": columns[error][when::2]
        for when, moment in enumerate(("initial", "final"))
        for error in ERRORS
    }
    labels = {"draw": draws, "scale": [*scales] * len(drawn)}
    return pd.DataFrame(labels | {"refused": history.refused[:, -1]} | table)
