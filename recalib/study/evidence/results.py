"""Everything that figures are drawn from and claims are judged by, as the workflow leaves it in its folders."""

import json
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas as pd

from recalib.randomness import generator
from recalib.study.experiments import tuned

ERRORS = ["position_error_cm", "orientation_error_deg"]


class Evidence:
    """Results by name.

    Args:
        config: the configuration.
    """

    def __init__(self, config: Mapping):
        self.config, self.results = config, Path(config["results"])
        self.paper, self.robot = config["search"]["scenario"], config["robot"]
        self.published: Mapping[str, float] = config["paper_damage"]["published"]
        self.scenarios: list[str] = config["experiments"]["scenarios"]

    def history(self, learner: str, scenario: str | None = None) -> pd.DataFrame:
        """A row for each seed and measurement of a training; the scenario is the paper's damage unless given."""
        return pd.read_parquet(
            self.results / "runs" / (scenario or self.paper) / f"{learner}.parquet"
        )

    def errors(self, learner: str, scenario: str | None = None, moment: str = "last") -> np.ndarray:
        """Position errors in cm and orientation errors in degrees (seed, 2) of the last or the first measurement."""
        history = self.history(learner, scenario)
        when = history["iteration"].max() if moment == "last" else history["iteration"].min()
        return history[history["iteration"] == when].sort_values("seed")[ERRORS].to_numpy()

    def ladder(self, name: str) -> dict[int, np.ndarray]:
        """Final errors (seed, 2) for each number of iterations that the learner was tuned and trained for."""
        learners = self.config["learners"]
        short = {
            tuned.training(learner, learners): learner
            for learner in self.config["experiments"]["learners"]
        }
        rungs = self.config["experiments"]["ladder"][name]
        return {
            rung: self.errors(short.get((name, rung), f"{name}_{rung}")) for rung in sorted(rungs)
        }

    def ensemble(self, learner: str, series: str) -> pd.DataFrame:
        """A row for each robot and scale of a series of other damages."""
        return pd.read_parquet(self.results / "ensemble" / f"{series}.{learner}.parquet")

    def study(self, name: str) -> pd.DataFrame:
        """A measurement of the true mapping."""
        return pd.read_parquet(self.results / "studies" / f"{name}.parquet")

    def assignments(self) -> pd.DataFrame:
        """The initial errors of every assignment of the paper's damage."""
        return pd.read_parquet(self.results / "assignments" / f"{self.robot}.parquet")

    def trials(self, training: str) -> pd.DataFrame:
        """The sample of the search for one training."""
        sample = pd.read_csv(Path(self.config["tuned"]) / "trials.csv")
        return sample[sample["training"] == training].dropna(axis=1)

    def claims(self) -> list[dict]:
        """The judged claims."""
        return json.loads((self.results / "claims.json").read_text())

    def rng(self, *keys: str) -> np.random.Generator:
        """Randomness of an interval."""
        return generator(self.config["seed"], "evidence", *keys)
