"""Two jobs that measure what sections 3 to 6 claim about cells, the true mapping and widths."""

from collections.abc import Callable, Sequence
from pathlib import Path

import pandas as pd

from recalib.numerics.randomness import generator
from replication.config.study import Study
from replication.config.switches import IMPROVED
from replication.mapping.nearness import nearness
from replication.mapping.propagation import propagation
from replication.mapping.quantisation import quantisation
from replication.mapping.solutions import solutions
from replication.mapping.true_mapping import coupling
from replication.mapping.visits import visits
from replication.scenarios.plants import Resolved
from replication.training.constant_widths import constant_widths
from replication.training.replay import replay
from replication.training.tuned import Tuned, rules_of


def measure(study: Study, scenarios: Sequence[Path], own: Path) -> tuple[pd.DataFrame, ...]:
    """Tables of coupling, nearness, propagation, quantisation, solutions and visits.

    `scenarios` are files of resolved scenarios of the study's robot; `own` has the paper's damage.
    """
    plan, seed, resolved = study.mapping, study.seed, [*map(Resolved.read, scenarios)]
    damage = Resolved.read(own)
    return (
        _in_each(study, resolved, "coupling", lambda *args, **_: coupling(*args)),
        nearness(damage, plan.poses, seed),
        propagation(damage, plan, seed),
        quantisation(seed),
        _in_each(study, resolved, "solutions", solutions),
        visits(seed),
    )


def learn(study: Study, own: Path, settings: Sequence[Path]) -> tuple[pd.DataFrame, ...]:
    """Tables of the improved system's learning: from recorded moves, and with constant widths."""
    damage, iterations = Resolved.read(own), study.experiments.iterations
    tuned = Tuned(study, settings)
    return (
        replay(damage, lambda: tuned.learner(IMPROVED, iterations, 1), iterations, study.seed),
        constant_widths(damage, rules_of(study.every_learner[IMPROVED]), study.seed),
    )


def _in_each(
    study: Study, scenarios: list[Resolved], name: str, measure: Callable[..., pd.DataFrame]
) -> pd.DataFrame:
    """The table of a measurement at random poses in each scenario."""
    tables = []
    for scenario in scenarios:
        controller, rng = scenario.controller(), generator(study.seed, "study", name)
        desired = controller.robot.workspace.sample(rng, study.mapping.poses)
        table = measure(controller, scenario.arm(controller.robot), desired, random=rng)
        tables.append(table.assign(scenario=scenario.scenario))
    return pd.concat(tables)
