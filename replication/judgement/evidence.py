"""What claims are judged by, figures are drawn from and pages say: the results of a study."""

import json
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from recalib.errors import RecalibError
from replication.config.campaign import Factors
from replication.config.shipped import CAMPAIGN, SHIPPED, root_of
from replication.config.study import Study
from replication.judgement.findings import Finding, read_findings
from replication.training.measured import ERRORS
from replication.training.plan import Place, places


class NotMeasured(RecalibError):
    """A study lacks what was asked for. Its text is the key that would bring it."""


class Evidence:
    """Results of a study below the project's folder; what is missing raises NotMeasured."""

    def __init__(self, study: Study, project: Path = Path()):
        self.study, self._project = study, project
        self._root = root_of(study.name)

    @property
    def shipped(self) -> bool:
        """Whether the study is the one of the README."""
        return self.study.name == SHIPPED

    def table(self, name: str) -> pd.DataFrame:
        """A table by its path below the folder of results, or below the project's.

        Raises NotMeasured: it is not there, or it is the campaign's, which another study has.
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
        """Position [cm] and orientation errors [degrees] (seed, 2), last or before learning."""
        history = self.history(learner, iterations, scenario)
        iteration = 0 if first else iterations
        rows = history[history["iteration"] == iteration].sort_values("seed")
        return rows[list(ERRORS)].to_numpy()

    def findings(self) -> dict[str, Finding]:
        """What was found about each claim, by its id. Raises NotMeasured: nothing was judged."""
        return read_findings(_there(self._project / self._root / "claims.json", "claims.json"))

    def assignments(self) -> pd.DataFrame:
        """Every assignment of the paper's damage to the study's robot, and its initial errors.

        Raises NotMeasured: no scenario of the study has a part of this damage.
        """
        table = self.table(f"assignments/{self.study.robot}.parquet")
        if table.empty:
            raise NotMeasured("scenarios: [{assigned: links}]")
        return table

    def outcomes(self) -> pd.DataFrame:
        """The campaign's table. Raises NotMeasured."""
        return self.table(f"{CAMPAIGN}/outcomes.csv")

    def halfway(self) -> pd.DataFrame:
        """More rows of Ritter's map, which were measured after the campaign. Raises NotMeasured."""
        return self.table(f"{CAMPAIGN}/halfway.csv")

    def levels(self) -> pd.DataFrame:
        """The levels of each setup's factors, by its number."""
        design = self.table(f"{CAMPAIGN}/design.csv").set_index("setup")
        return design[list(Factors.model_fields)]

    def mapping(self, name: str) -> pd.DataFrame:
        """One of the tables of the mapping."""
        return self.table(f"mapping/{name}.parquet")

    def scenario(self) -> dict[str, Any]:
        """The study's own scenario as resolved."""
        place = Place(self.study.robot, self.study.scenario)
        return json.loads((self._project / place.scenario_file(self._root)).read_text("utf-8"))


def _there(path: Path, name: str) -> Path:
    """The path of a file. Raises NotMeasured, with its name."""
    if not path.is_file():
        raise NotMeasured(name)
    return path


@cache
def _read(path: Path) -> pd.DataFrame:
    return (pd.read_parquet if path.suffix == ".parquet" else pd.read_csv)(path)
