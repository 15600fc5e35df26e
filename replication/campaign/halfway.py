"""Ritter's map between its last two lengths, in every setup: exploratory, after the campaign.

Where its error falls fast and then slowly, a straight line between 5,000 and 20,000 iterations
reaches the improved system's error too late.
"""

from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd

from replication.campaign.measuring import SHARES, Replicate, rows_of, short
from replication.campaign.setups import read_design
from replication.campaign.variants import DOUBLE, variants
from replication.config.study import Study
from replication.training.poses import Stream
from replication.training.search import Tuning

ITERATIONS = 10_000


def halfway(study: Study, design: Path, outcomes: Path, setup: int, replicate: int) -> pd.DataFrame:
    """The row of Ritter's map after `ITERATIONS`, tuned near its settings for 5,000 iterations."""
    plan, variant = study.search, variants(study)[DOUBLE]
    measured = Replicate(study, read_design(design)[setup], replicate)
    trials = partial(measured.trials, variant, ITERATIONS)
    numbers = range(1, plan.searches + 1)
    tuning = Tuning(
        [trials(plan.long_runs, Stream.SEARCH, number=number) for number in numbers],
        trials(plan.fresh, Stream.SEARCH, number=0),
        plan.model_copy(update={"seed": plan.seed + 1000 * replicate}),
    )
    rows = pd.read_csv(outcomes).query("setup == @setup and replicate == @replicate")
    shorter = rows_of(rows[rows["variant"] == DOUBLE])[study.campaign.rungs[0]]
    start = np.array([shorter[name] for name in tuning.fresh.space.columns])
    found = tuning.search(starts=np.tile(start, (plan.searches, 1)))
    shares = trials(study.campaign.runs, Stream.SETUP).shares(found.best[None])[0]
    return pd.DataFrame(
        [
            {"setup": setup, "replicate": replicate, "variant": DOUBLE, "iterations": ITERATIONS}
            | dict(zip(SHARES, map(short, shares), strict=True))
            | {"trials": found.trials, "settled": int(found.settled)}
        ]
    )
