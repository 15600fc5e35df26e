"""Samples of the searches in files: all trials for a training, below what was searched for.

Reading the head of a file needs no table: the workflow does it whenever it starts.
"""

import csv
from operator import itemgetter
from pathlib import Path
from typing import TYPE_CHECKING

from recalib.errors import InvalidFile
from recalib.study.configuration.part import Frozen
from recalib.study.configuration.study import Budget, LearnerSettings, Study
from recalib.study.plan.trainings import budget, rules, searches

if TYPE_CHECKING:
    import pandas as pd

COMMENT = "# "
NO_SAMPLE = "it holds no sample of the search; try: delete it, and it is made anew"


class Sought(Frozen):
    """What was searched for, how often, with how much, and on what: the head of a sample."""

    learner: LearnerSettings
    searches: int
    budget: Budget
    robot: str
    scenario: str


def sought(study: Study, training: str) -> Sought:
    """What the searches for a training of a study are for."""
    return Sought(
        learner=rules(study, training),
        searches=searches(study, training),
        budget=budget(study),
        robot=study.robot,
        scenario=study.scenario,
    )


def put_together(trials: list[Path], sought: Sought) -> str:
    """The sample of the searches in these files."""
    import pandas as pd

    return sample_of(sought, pd.concat(map(pd.read_csv, trials), ignore_index=True))


def sample_of(sought: Sought, trials: "pd.DataFrame") -> str:
    """A file with the trials (a row each) of the searches for a training."""
    return COMMENT + sought.model_dump_json() + "\n" + trials.to_csv(index=False)


def searched_for(path: str | Path) -> Sought:
    """What the sample in a file was searched for. Raises InvalidFile."""
    try:
        with Path(path).open(encoding="utf-8") as lines:
            return Sought.model_validate_json(next(lines).removeprefix(COMMENT))
    except (ValueError, StopIteration):
        raise InvalidFile(path, NO_SAMPLE) from None


def winners(path: str | Path) -> list[dict[str, float]]:
    """The trial in a file that each search keeps, in their order. Raises InvalidFile.

    As `best(read_sample(path))`, without a table: every training starts with this.
    """
    trials: dict[float, list[dict[str, float]]] = {
        number: [] for number in range(1, searched_for(path).searches + 1)
    }
    try:
        with Path(path).open(encoding="utf-8", newline="") as lines:
            next(lines)
            for row in csv.DictReader(lines):
                trial = {name: float(text) for name, text in row.items()}
                trials[trial["search"]].append(trial)
        return [min(its, key=itemgetter("score")) for its in trials.values()]
    except (KeyError, TypeError, ValueError):  # also where a search has no trial
        raise InvalidFile(path, NO_SAMPLE) from None


def read_sample(path: str | Path) -> "pd.DataFrame":
    """The trials in a file, a row each. Raises InvalidFile."""
    import pandas as pd

    searched_for(path)
    return pd.read_csv(path, skiprows=1)
