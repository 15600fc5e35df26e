"""What sections 3 to 5 say of the cells and of the true mapping, in one job."""

from pathlib import Path

import pandas as pd

from recalib.study.mapping.coupling import couplings
from recalib.study.mapping.nearness import nearness
from recalib.study.mapping.propagation import propagation
from recalib.study.mapping.quantisation import quantisation
from recalib.study.mapping.solutions import in_scenarios


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
        couplings(scenarios, poses, seed),
        nearness(own, poses, seed),
        propagation(own, balls, points, radius, scales, seed),
        quantisation(seed),
        in_scenarios(scenarios, poses, seed),
    )
