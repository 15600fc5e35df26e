"""What figures are drawn from and claims are judged by: what was declared, and no more."""

import json
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from typing_extensions import TypedDict  # pydantic needs this one before Python 3.12

from recalib.numerics.randomness import generator
from replication.config.part import Frozen
from replication.config.shipped import DESIGN, FACTORS, RESULTS, SHIPPED, pieces
from replication.config.universes import Factors
from replication.config.values import from_file
from replication.judgement.measured import errors_of

if TYPE_CHECKING:
    import pandas as pd

    from replication.training.samples import Sought


Words = dict[str, dict[str, str]]  # by factor: what it `asks`, and by level what completes that


class Facts(TypedDict, total=False):
    """What may be known of a study beside its results; see `replication.judgement.needs`."""

    seed: int
    robot: str
    scenario: str
    scenarios: list[str]
    elsewhere: dict[str, str]
    published: dict[str, float]
    published_mm: dict[str, float]
    iterations: int
    improved: str
    ritter: str
    short: str
    compared: list[str]
    learners: list[str]
    beside: list[str]
    switched: list[str]
    ladder: dict[str, list[tuple[int, str]]]
    setups: dict[str, int]
    rough_trials: int
    coupling_poses: int
    balls: int
    points: int
    radius: float
    assignment_poses: int
    short_searches: int
    searches_long: int
    tests: int
    measure_every: int
    real_robot: str
    real_poses: list[int]
    budgets: list[int]
    threshold: float


class Evidence(Frozen):
    """Results by name: what a claim, a figure or a page declared, and may read.

    There is nothing else in it: of what is read and was not declared, a change would go unnoticed.

    Attributes:
        root: folder of the study's results.
        files: paths by name: below that folder, or for what is shipped in the project.
        facts: what is known of the study beside its results.
    """

    root: str
    files: dict[str, str]
    facts: Facts

    @property
    def inputs(self) -> list[str]:
        """The paths of all files."""
        return list(self.files.values())

    @property
    def study(self) -> str:
        """The study's name."""
        return Path(self.root).name if self.root != RESULTS else SHIPPED

    @property
    def shipped(self) -> bool:
        """Whether the study is the one of the README."""
        return self.study == SHIPPED

    def table(self, name: str) -> "pd.DataFrame":
        """What a table holds."""
        import pandas as pd

        return (pd.read_parquet if name.endswith(".parquet") else pd.read_csv)(self.files[name])

    def history(self, learner: str, scenario: str | None = None) -> "pd.DataFrame":
        """A row for each seed and measurement of a training; the study's own scenario is usual."""
        return self.table(f"runs/{scenario or self.facts['scenario']}/{learner}.parquet")

    def errors(self, learner: str, scenario: str | None = None, moment: str = "last") -> np.ndarray:
        """Position [cm] and orientation errors [degrees], last or first measurement.

        (search, seed, 2): the winner of each search with its seeds.
        """
        return errors_of(self.history(learner, scenario), moment)

    def ladder(self, learner: str) -> dict[int, np.ndarray]:
        """Final errors (search, seed, 2) for each number of iterations that it was trained for."""
        return {rung: self.errors(name) for rung, name in self.facts["ladder"][learner]}

    def assignments(self) -> "pd.DataFrame":
        """The initial errors of every assignment of the paper's damage."""
        from replication.scenarios.assignments import TIE

        table = self.table(f"assignments/{self.facts['robot']}.parquet")
        return table.assign(distance=table["distance"].round(TIE))

    def nearest_assignment(self) -> "pd.Series":
        """The assignment that is used: the first of those that are nearest."""
        table = self.assignments()
        return table.loc[table["distance"].idxmin()]

    def sample(self, learner: str) -> "pd.DataFrame":
        """All trials of the searches for a training, a row each."""
        from replication.training.samples import read_sample

        return read_sample(self.files[f"search/{learner}.csv"])

    def sought(self, learner: str) -> "Sought":
        """What the searches for a training could spend, and on what."""
        from replication.training.samples import searched_for

        return searched_for(self.files[f"search/{learner}.csv"])

    def scenario(self, scenario: str | None = None) -> dict:
        """A damage as resolved."""
        return self._read(f"scenarios/{scenario or self.facts['scenario']}.json")

    def claims(self) -> list[dict]:
        """The judged claims."""
        return self._read("claims.json")

    def _read(self, name: str):
        return json.loads(Path(self.files[name]).read_text(encoding="utf-8"))

    def setups(self, table: str) -> "pd.DataFrame | None":
        """A row for each replicate of each alternative setup; None unless all are measured.

        Of the outcomes, or of the horizon: how long Ritter's takes.
        """
        import pandas as pd

        names = pieces(table, self.facts["setups"][table])
        if not set(names) & set(self.files):
            return None
        return pd.concat(map(self.table, names), ignore_index=True)

    def levels(self) -> "pd.DataFrame":
        """The levels of each setup's factors."""
        return self.table(DESIGN)[list(Factors.model_fields)]

    def words(self) -> Words:
        """The factors of the setups in words."""
        return from_file(self.files[FACTORS]).plain()

    def rng(self, *keys: str) -> np.random.Generator:
        """Randomness of an interval."""
        return generator(self.facts["seed"], "evidence", *keys)
