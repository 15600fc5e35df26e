"""What is recorded of a study: in each of its scenarios, one training of some learners."""

from pathlib import Path

import pandas as pd

from replication.config.damages import Assigned
from replication.config.study import Study
from replication.training.plan import Place

TODAYS, MOVES = "geometric", 5  # one of today's learners, for the study's own scenario alone


def recorded_places(study: Study) -> list[Place]:
    """Each of them has a recording."""
    return [Place(study.robot, scenario) for scenario in study.experiments.scenarios]


def recorded_iterations(study: Study) -> int:
    """Iterations of the trainings that are recorded: the shortest that figures show."""
    return min(map(min, study.experiments.learners.values()))


def recorded_learners(study: Study) -> list[str]:
    """The paper's learners that are recorded side by side: all that are trained for so long."""
    iterations = recorded_iterations(study)
    return [name for name, its in study.experiments.learners.items() if iterations in its]


def recorded_history(study: Study, history: Path) -> pd.DataFrame:
    """The history of the trainings of a learner of which one is recorded."""
    table = pd.read_parquet(history)
    return table[table["iterations"] == recorded_iterations(study)]


def typical_seed(history: pd.DataFrame) -> int:
    """The seed of the training that ends with the median position error of all."""
    last = history[history["iteration"] == history["iteration"].max()]
    order = last["position_error_cm"].argsort(kind="stable")
    return int(last["seed"].iloc[order.iloc[len(last) // 2]])


def published_errors(study: Study, scenario: str) -> dict[str, float]:
    """The initial errors in the paper by quantity, where a scenario is the paper's damage."""
    if scenario != study.scenario:
        return {}
    assigned = any(isinstance(entry, Assigned) for entry in study.scenarios[scenario])
    return study.paper_damage.published.model_dump() if assigned else {}
