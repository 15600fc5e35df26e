"""The errors on the real arm, with intervals over random subsets of the recorded poses."""

from pathlib import Path
from typing import TYPE_CHECKING

from recalib.randomness import generator
from recalib.study.statistics import bootstrap

if TYPE_CHECKING:
    import pandas as pd

ERROR = "position_error_mm"


def put_together(runs: list[Path], seed: int) -> "pd.DataFrame":
    """The errors of the learners in these files."""
    import pandas as pd

    return real_errors(pd.concat(map(pd.read_csv, runs)), seed)


def real_errors(runs: "pd.DataFrame", seed: int) -> "pd.DataFrame":
    """A row for each learner and number of poses.

    Args:
        runs: a row for each learner, number of poses and subset.
        seed: of the study.
    """
    import pandas as pd

    rows = []
    for (learner, poses), own in runs.groupby(["learner", "poses"], sort=False):
        estimate = bootstrap(own[ERROR], generator(seed, "real", learner, poses))
        cells = {"learner": learner, "poses": poses, "subsets": len(own)}
        rows.append(cells | estimate.columns(ERROR))
    return pd.DataFrame(rows)
