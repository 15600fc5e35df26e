"""The errors on the real arm, and what its page says of them."""

from pathlib import Path
from typing import TYPE_CHECKING

from recalib.numerics.randomness import generator
from replication.judgement.intervals import bootstrap
from replication.judgement.results import Evidence
from replication.training.competitors import label_of

if TYPE_CHECKING:
    import pandas as pd

ERROR = "position_error_mm"

NEEDS = "real.csv real_robot published_mm real_poses"
TWIN = "twin"  # is part of the name of a learner that was run on it


def put_together(runs: list[Path], seed: int) -> "pd.DataFrame":
    """The errors of the learners in these files."""
    import pandas as pd

    return real_errors(pd.concat(map(pd.read_csv, runs)), seed)


def real_errors(runs: "pd.DataFrame", seed: int) -> "pd.DataFrame":
    """A row for each learner and number of poses, from one for each of their subsets."""
    import pandas as pd

    rows = []
    for (learner, poses), own in runs.groupby(["learner", "poses"], sort=False):
        estimate = bootstrap(own[ERROR], generator(seed, "real", learner, poses))
        cells = {"learner": learner, "poses": poses, "subsets": len(own)}
        rows.append(cells | estimate.columns(ERROR))
    return pd.DataFrame(rows)


def context(evidence: Evidence) -> dict:
    """Everything that the page may say."""
    table, published = evidence.table("real.csv"), evidence.facts["published_mm"]
    errors: dict[str, dict[int, str]] = {}
    for row in table.to_dict("records"):
        name, _, twin = row["learner"].partition(" ")
        its = errors.setdefault(f"{label_of(name)} {twin}".strip(), {})
        its[row["poses"]] = f"{row[ERROR]:.3f}"
    return {
        "robot": evidence.facts["real_robot"].upper(),
        "before": published["before_mm"],
        "after": published["after_mm"],
        "poses": evidence.facts["real_poses"],
        "errors": errors,
        "ends": {name: max(its.items()) for name, its in errors.items() if TWIN in name},
        "subsets": table["subsets"].max(),
    }
