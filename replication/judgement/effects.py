"""The choice of a setup on which a number depends most."""

import numpy as np
import pandas as pd
from scipy.stats import f_oneway

from replication.judgement.hierarchy import LEVEL


def strongest(numbers: np.ndarray, levels: pd.DataFrame) -> str | None:
    """The factor with the strongest effect on a number, if it is significant; otherwise None.

    The analysis of variance has a level of 5 % over all factors (Bonferroni). The design is
    balanced, so the other factors average out in the analysis of one factor.

    Args:
        numbers: (setup,) on the scale on which they are averaged.
        levels: (setup, factor) the levels.
    """
    chances = {}
    for factor, level in levels.items():
        groups = [numbers[level == name] for name in level.unique()]
        several = [group for group in groups if len(group) > 1]
        chances[factor] = f_oneway(*several).pvalue if len(several) > 1 else 1.0
    least = min(chances, key=lambda factor: chances[factor])
    return str(least) if chances[least] * len(chances) < 1 - LEVEL else None
