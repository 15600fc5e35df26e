"""The power of the second campaign: its model and verdicts, on simulated data of known truth."""

from itertools import product

import numpy as np
import pandas as pd

from recalib.study.evidence.verdicts import RATIO, Verdict
from recalib.study.inference.hierarchy import ASSUMED_LUCK, hierarchy
from recalib.study.inference.intervals import Estimate

STUDIES = 1000
EFFECTS = 1.0, 0.95, 0.93, 0.91, 0.9
HETEROGENEITIES = 0.0, 0.1, 0.2


def power(setups: int, replicates: int, studies: int = STUDIES) -> pd.DataFrame:
    """Shares of simulated campaigns, a row for each true mean effect and heterogeneity.

    Columns: each verdict; `found`, where the interval of the heterogeneity excludes zero; and for
    each part of the model how often its interval holds the truth.

    Args:
        setups: half of them of full effort, the others of rough.
        replicates: of each setup.
    """
    effort = np.array(list(ASSUMED_LUCK))[np.arange(setups) % len(ASSUMED_LUCK)]
    spread = np.array([ASSUMED_LUCK[level] for level in effort])
    rows = []
    for number, (effect, own) in enumerate(product(EFFECTS, HETEROGENEITIES)):
        random = np.random.default_rng([1996, number])
        campaigns = [
            _study(random, effort, spread, replicates, np.log(effect), own) for _ in range(studies)
        ]
        shares = pd.DataFrame(campaigns).mean().to_dict()
        rows.append({"effect": effect, "heterogeneity": own} | shares)
    return pd.DataFrame(rows)


def _study(
    random: np.random.Generator,
    effort: np.ndarray,
    spread: np.ndarray,
    replicates: int,
    mean: float,
    own: float,
) -> dict[str, bool]:
    """One campaign: whether what each column says is true of it."""
    true = mean + own * random.normal(size=len(effort) + 1)  # the last one is another setup
    values = true[:-1, None] + spread[:, None] * random.normal(size=(len(effort), replicates))
    found = hierarchy(values, effort)
    verdict = RATIO.verdict(Estimate(*np.exp(found.mean)))
    said = {str(possible): verdict is possible for possible in Verdict}
    said["found"] = found.heterogeneity.low > 0
    luck = np.sqrt(np.square(spread).mean())
    truths = {"mean": mean, "heterogeneity": own, "luck": luck, "another": true[-1]}
    for part, truth in truths.items():
        interval: Estimate = getattr(found, part)
        said[f"{part}_covered"] = interval.low <= truth <= interval.high
    return said
