"""The design: for each setup, a level of every factor that the paper leaves open."""

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from scipy.stats.qmc import LatinHypercube

from replication.config.campaign import Campaign, Factors

BATCHES = 3  # of rows; the second and third replace rows that a robot refuses


class Row(NamedTuple):
    """A row of the design."""

    number: int  # 0 is the reference study, with the first level of each factor
    levels: dict[str, Any]  # the level of each factor
    share: float  # in [0, 1), selects one of all assignments of the damage, if the level is "any"


def rows(plan: Campaign) -> Iterator[Row]:
    """The rows of the design, followed by replacements for rows that a robot refuses.

    The first row is the reference study. The rest is a Latin hypercube: the levels of each factor
    occur equally often, and factors are almost uncorrelated.
    """
    factors = {name: getattr(plan.factors, name) for name in Factors.model_fields}
    yield Row(0, {name: levels[0] for name, levels in factors.items()}, 0.0)
    number = 0
    for batch in range(BATCHES):
        random = np.random.default_rng([plan.seed, batch])
        sampler = LatinHypercube(len(factors) + 1, optimization="random-cd", rng=random)
        for *numbers, share in sampler.random(plan.setups - 1).tolist():
            number += 1
            pairs = zip(factors.items(), numbers, strict=True)
            drawn = {name: levels[int(u * len(levels))] for (name, levels), u in pairs}
            yield Row(number, drawn, share)
