"""What is recorded of a study: in each of its scenarios, one training like that of Figure 1."""

from pathlib import Path

import pandas as pd

from replication.config.study import Study
from replication.training.plan import Place, leading


def recorded_places(study: Study) -> list[Place]:
    """Each of them has a recording."""
    return [Place(study.robot, scenario) for scenario in study.experiments.scenarios]


def recorded_history(study: Study, history: Path) -> pd.DataFrame:
    """The history of the trainings of which one is recorded."""
    table = pd.read_parquet(history)
    return table[table["iterations"] == leading(study).iterations]


def typical_seed(history: pd.DataFrame) -> int:
    """The seed of the training that ends with the median position error of all."""
    last = history[history["iteration"] == history["iteration"].max()]
    order = last["position_error_cm"].argsort(kind="stable")
    return int(last["seed"].iloc[order.iloc[len(last) // 2]])
