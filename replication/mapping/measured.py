"""What sections 3 to 5 say of the cells and of the true mapping, in one job."""

from collections.abc import Callable, Sequence
from pathlib import Path

import pandas as pd

from recalib.numerics.randomness import generator
from replication.mapping.coupling import coupling
from replication.mapping.nearness import nearness
from replication.mapping.propagation import propagation
from replication.mapping.quantisation import quantisation
from replication.mapping.solutions import solutions
from replication.scenarios.plants import Resolved


def measure(
    scenarios: list[Path],
    own: Path,
    poses: int,
    balls: int,
    points: int,
    radius: float,
    scales: tuple[float, ...],
    seed: int,
) -> tuple[pd.DataFrame, ...]:
    """Coupling, nearness, propagation, quantisation and solutions.

    `own` is the scenario with the paper's damage.
    """
    return (
        _in_each(scenarios, poses, seed, "coupling", lambda *its, **_: coupling(*its)),
        nearness(own, poses, seed),
        propagation(own, balls, points, radius, scales, seed),
        quantisation(seed),
        _in_each(scenarios, poses, seed, "solutions", solutions),
    )


def _in_each(
    scenarios: Sequence[Path],
    poses: int,
    seed: int,
    name: str,
    measure: Callable[..., pd.DataFrame],
) -> pd.DataFrame:
    """What is measured at so many random poses of each scenario, from their files as resolved."""
    tables = []
    for scenario in map(Resolved.read, scenarios):
        controller, rng = scenario.controller(), generator(seed, "study", name)
        desired = controller.robot.workspace.sample(rng, poses)
        table = measure(controller, scenario.arm(controller.robot), desired, random=rng)
        tables.append(table.assign(scenario=scenario.scenario))
    return pd.concat(tables)
