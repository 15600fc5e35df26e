"""The recorded trainings of a study: in each scenario, one like the training of Figure 1."""

from pathlib import Path

import pandas as pd

from replication.config.study import Study
from replication.training.plan import Place, leading


def recorded_places(study: Study) -> list[Place]:
    """The places that have a recording."""
    return [Place(study.robot, scenario) for scenario in study.experiments.scenarios]


def recorded_history(study: Study, history: Path) -> pd.DataFrame:
    """The histories of the trainings with the recorded number of iterations."""
    table = pd.read_parquet(history)
    return table[table["iterations"] == leading(study).iterations]


def typical_seed(history: pd.DataFrame) -> int:
    """The seed of the training whose final position error is the median."""
    last = history[history["iteration"] == history["iteration"].max()]
    order = last["position_error_cm"].argsort(kind="stable")
    return int(last["seed"].iloc[order.iloc[len(last) // 2]])
