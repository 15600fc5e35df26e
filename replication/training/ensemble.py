"""Trainings on many assignments of the paper's damage: robots of their own, at several scales."""

from collections.abc import Iterator, Sequence
from itertools import islice
from pathlib import Path

import pandas as pd

from recalib.damaged.damage import Damage, DamagedArm, apply
from recalib.damaged.plant import Plant
from recalib.errors import InvalidSetting
from recalib.nominal.robots import Robot
from recalib.numerics.randomness import generator
from replication.config.study import LearnerSettings
from replication.scenarios.assignments import Ways
from replication.scenarios.nominal import Nominal
from replication.scenarios.plants import nominal_controller
from replication.training.measured import ERRORS
from replication.training.poses import Stream, train_for_results
from replication.training.settings import build_tuned


def scaled_arm(robot: Robot, damages: Sequence[Damage], scale: float) -> DamagedArm:
    """The arm with the damages `scale` times as large. Raises InvalidSetting: too short a link."""
    return apply(robot, [damage.scaled(scale) for damage in damages])


def feasible(robot: Robot, ways: Ways, order: Sequence[int], scale: float) -> Iterator[tuple]:
    """Of the assignments in this order, the damages of those for which links are long enough."""
    for index in order:
        try:
            scaled_arm(robot, ways[index], scale)
        except InvalidSetting:
            continue
        yield ways[index]


def train_draws(
    sample: Path,
    nominal: Nominal,
    shorten: tuple[float, ...],
    shift: tuple[float, ...],
    series: str,
    scales: tuple[float, ...],
    first: int,
    last: int,
    rules: LearnerSettings,
    tests: int,
    seed: int,
) -> pd.DataFrame:
    """Train a learner on some robots of a series, each with all scales of its damage.

    Args:
        sample: file of the searches for this training, whose winners the robots get in turn.
        shorten, shift: the paper's damage [m, rad]; see `Ways`.
        scales: factors of all amounts.
        first, last: the first robot of the series that is one of them, and one past the last.

    Returns a row for each robot and scale.
    """
    controller = nominal_controller(nominal)
    robot, iterations = controller.robot, rules.iterations
    ways = Ways(nominal.robot.links, shorten, robot.joints, shift)
    order = generator(seed, "ensemble", series).permutation(len(ways)).tolist()
    drawn = list(islice(feasible(robot, ways, order, max(scales)), first, last))
    cases = [(index, scale) for index in range(len(drawn)) for scale in scales]
    arms = [scaled_arm(robot, drawn[index], scale) for index, scale in cases]
    runs = [first + index for index, _ in cases]
    history = train_for_results(
        Plant(controller, arms),
        build_tuned(rules, sample, [run + 1 for run in runs]),
        Stream.ENSEMBLE.draw(seed, runs, iterations, tests),
        [0, iterations],
    )
    table = {
        "robot": runs,
        "scale": [scale for _, scale in cases],
        "refused": history.refused[:, -1],
    }
    columns = history.columns()
    for when, moment in enumerate(("initial", "final")):
        table |= {f"{moment}_{error}": columns[error][when::2] for error in ERRORS}
    return pd.DataFrame(table)
