"""A sample of the readings of the paper: for each universe, a level of every factor."""

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from recalib.study.configuration.universes import Factors, Universes


class SobolRow(NamedTuple):
    """A row of the quasi-random sequence.

    Attributes:
        number: of the row.
        levels: of each factor.
        share: in [0, 1), where among all assignments of the damage one would be taken.
    """

    number: int
    levels: dict[str, Any]
    share: float


def rows(plan: Universes) -> Iterator[SobolRow]:
    """The rows of the design, and as many again to replace those that a robot refuses.

    A Sobol sequence: of a power of two of rows, the levels of each factor have equal shares, and so
    have the levels of most pairs.
    """
    from scipy.stats import qmc  # a third of a second, which only drawing a sample needs

    names = list(Factors.model_fields)
    power = math.ceil(math.log2(plan.count)) + 1
    sequence = qmc.Sobol(len(names) + 1, rng=np.random.default_rng(plan.seed))
    for number, (*numbers, share) in enumerate(sequence.random_base2(power).tolist()):
        valid = [getattr(plan.factors, name) for name in names]
        chosen = (levels[int(u * len(levels))] for levels, u in zip(valid, numbers, strict=True))
        yield SobolRow(number, dict(zip(names, chosen, strict=True)), share)
