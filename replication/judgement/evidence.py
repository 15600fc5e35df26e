"""The results of a study: the evidence for verdicts, figures and pages."""

import json
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from recalib.errors import RecalibError
from replication.config.campaign import Factors
from replication.config.shipped import CAMPAIGN, DESIGN, OUTCOMES, SHIPPED, root_of
from replication.config.study import Study
from replication.judgement.findings import Finding, read_findings
from replication.training.measured import ERRORS
from replication.training.plan import Place, places


class NotMeasured(RecalibError):
    """A result is missing in a study. The text is the configuration key that would add it."""


class Evidence:
    """The results of a study in the project's folder. A missing result raises NotMeasured."""

    def __init__(self, study: Study, project: Path = Path()):
        self.study, self._project = study, project
        self._root = root_of(study.name)

    @property
    def shipped(self) -> bool:
        """Whether the study is the shipped replication, which the README describes."""
        return self.study.name == SHIPPED

    def table(self, name: str) -> pd.DataFrame:
        """A table by its path in the folder of results, or in the project's folder.

        Raises NotMeasured if it is missing, or if it is the campaign's and this is another study.
        """
        if name.startswith(CAMPAIGN) and not self.shipped:
            raise NotMeasured(f"name: {SHIPPED}")
        path = self._project / (name if name.startswith("workflow/") else f"{self._root}/{name}")
        return _read(_there(path, name))

    def history(
        self,
        learner: str,
        iterations: int,
        scenario: str | None = None,
        robot: str | None = None,
    ) -> pd.DataFrame:
        """A row for each seed and measurement of a training, by default on the paper's damage."""
        place = Place(robot or self.study.robot, scenario or self.study.scenario)
        if iterations not in places(self.study).get(place, {}).get(learner, ()):
            raise NotMeasured(f"experiments.learners.{learner}: [{iterations}]")
        path = place.history_file(self._root, learner)
        table = _read(_there(self._project / path, path))
        return table[table["iterations"] == iterations]

    def errors(
        self, learner: str, iterations: int, scenario: str | None = None, first: bool = False
    ) -> np.ndarray:
        """Position [cm] and orientation errors [degrees] (seed, 2), at the end or (first) start."""
        history = self.history(learner, iterations, scenario)
        iteration = 0 if first else iterations
        rows = history[history["iteration"] == iteration].sort_values("seed")
        return rows[list(ERRORS)].to_numpy()

    def findings(self) -> dict[str, Finding]:
        """The finding about each claim, by its id. Raises NotMeasured if there are no verdicts."""
        return read_findings(_there(self._project / self._root / "claims.json", "claims.json"))

    def assignments(self) -> pd.DataFrame:
        """All assignments of the paper's damage to the study's robot, with their initial errors.

        Raises NotMeasured if no scenario of the study has a part of this damage.
        """
        table = self.table(f"assignments/{self.study.robot}.parquet")
        if table.empty:
            raise NotMeasured("scenarios: [{assigned: links}]")
        return table

    def outcomes(self) -> pd.DataFrame:
        """The campaign's table. Raises NotMeasured."""
        return self.table(OUTCOMES)

    def levels(self) -> pd.DataFrame:
        """The levels of all factors in each setup, by the setup's number."""
        design = self.table(DESIGN).set_index("setup")
        return design[list(Factors.model_fields)]

    def mapping(self, name: str) -> pd.DataFrame:
        """A table of the mapping, by its name."""
        return self.table(f"mapping/{name}.parquet")

    def scenario(self) -> dict[str, Any]:
        """The study's main scenario, resolved."""
        place = Place(self.study.robot, self.study.scenario)
        return json.loads((self._project / place.scenario_file(self._root)).read_text("utf-8"))


def _there(path: Path, name: str) -> Path:
    """The path itself, if the file exists; otherwise raises NotMeasured with the file's name."""
    if not path.is_file():
        raise NotMeasured(name)
    return path


@cache
def _read(path: Path) -> pd.DataFrame:
    return (pd.read_parquet if path.suffix == ".parquet" else pd.read_csv)(path)
