"""Trainings on other assignments of the paper's damage, each at several scales."""

from collections.abc import Iterator, Sequence
from itertools import islice
from pathlib import Path

import pandas as pd

from recalib.damaged.damage import Damage, DamagedArm, apply
from recalib.damaged.plant import Plant
from recalib.errors import InvalidSetting
from recalib.nominal.robots import Robot
from recalib.numerics.randomness import generator
from replication.config.study import Study
from replication.config.switches import IMPROVED
from replication.scenarios.assignments import Assignment, Ways
from replication.scenarios.plants import nominal_controller, nominal_of
from replication.training.measured import ERRORS
from replication.training.poses import Stream, train_for_results
from replication.training.tuned import Tuned


def scaled_arm(robot: Robot, damages: Sequence[Damage], scale: float) -> DamagedArm:
    """The arm with damages times `scale`. Raises InvalidSetting if a link is too short."""
    return apply(robot, [damage.scaled(scale) for damage in damages])


def feasible(robot: Robot, ways: Ways, order: Sequence[int], scale: float) -> Iterator[Assignment]:
    """The damages of assignments, in this order, for which the links are long enough."""
    for index in order:
        try:
            scaled_arm(robot, ways[index], scale)
        except InvalidSetting:
            continue
        yield ways[index]


def train_ensemble(study: Study, settings: Sequence[Path]) -> pd.DataFrame:
    """Train the improved system on the ensemble's robots.

    Returns a row for each draw and scale, with both errors before and after learning.
    """
    nominal, plan = nominal_of(study, study.robot), study.experiments
    controller, scales = nominal_controller(nominal), plan.ensemble.scales
    robot, damage = controller.robot, study.paper_damage
    ways = Ways(nominal.robot.links, damage.shorten, robot.joints, damage.shift)
    order = generator(study.seed, "ensemble", "scaled").permutation(len(ways)).tolist()
    drawn = islice(feasible(robot, ways, order, max(scales)), plan.ensemble.draws)
    cases = [(*draw, scale) for draw in enumerate(drawn) for scale in scales]
    draws = [draw for draw, _, _ in cases]
    history = train_for_results(
        Plant(controller, [scaled_arm(robot, damages, scale) for _, damages, scale in cases]),
        Tuned(study, settings).learner(IMPROVED, plan.iterations, len(cases)),
        Stream.ENSEMBLE.draw(study.seed, draws, plan.iterations, study.training.tests),
        [0, plan.iterations],
    )
    columns = history.columns()
    table = {
        f"{moment}_{error}": columns[error][when::2]
        for when, moment in enumerate(("initial", "final"))
        for error in ERRORS
    }
    labels = {"draw": draws, "scale": [scale for _, _, scale in cases]}
    return pd.DataFrame(labels | {"refused": history.refused[:, -1]} | table)
