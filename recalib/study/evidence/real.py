"""The errors on the real arm, with intervals over random subsets of the recorded poses."""

from typing import TYPE_CHECKING

from recalib.randomness import generator
from recalib.study import jobs
from recalib.study.statistics import bootstrap

if TYPE_CHECKING:
    import pandas as pd

ERROR = "position_error_mm"


def real_errors(job: jobs.RealTable, runs: "pd.DataFrame") -> "pd.DataFrame":
    """A row for each learner and number of poses.

    Args:
        job: the seed.
        runs: a row for each learner, number of poses and subset.
    """
    import pandas as pd

    rows = []
    for (learner, poses), own in runs.groupby(["learner", "poses"], sort=False):
        estimate = bootstrap(own[ERROR], generator(job.seed, "real", learner, poses))
        cells = {"learner": learner, "poses": poses, "subsets": len(own)}
        rows.append(cells | estimate.columns(ERROR))
    return pd.DataFrame(rows)
