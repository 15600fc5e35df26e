"""On which of a setup's choices a number depends."""

import numpy as np
import pandas as pd
from scipy.stats import f_oneway

from replication.judgement.hierarchy import LEVEL


def strongest(numbers: np.ndarray, levels: pd.DataFrame) -> str | None:
    """The factor that moves a number most, if chance rarely does as much.

    In 95 % of designs in which no factor has an effect, none is named (Bonferroni). The design is
    balanced: the other factors average out where one is looked at.

    Args:
        numbers: (setup,) in the scale in which they are averaged.
        levels: (setup, factor).
    """
    chances = {}
    for factor, level in levels.items():
        groups = [numbers[level == name] for name in level.unique()]
        several = [group for group in groups if len(group) > 1]
        chances[factor] = f_oneway(*several).pvalue if len(several) > 1 else 1.0
    least = min(chances, key=lambda factor: chances[factor])
    return str(least) if chances[least] * len(chances) < 1 - LEVEL else None
