"""What figures are drawn from and claims are judged by: what was declared, and no more."""

import json
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from pydantic import JsonValue

from recalib.errors import RecalibError
from recalib.randomness import generator
from recalib.study import jobs
from recalib.study.configuration.universes import Factors
from recalib.study.evidence.needs import Needs
from recalib.study.layout import (
    DESIGN,
    DEVIATIONS,
    EFFORTS,
    FIRST,
    POWER,
    REFERENCE,
    SECOND,
    SHIPPED,
    Layout,
    pieces,
)
from recalib.study.measured import errors_of

if TYPE_CHECKING:
    import pandas as pd


class Undeclared(RecalibError):
    """Something that was read without being declared: a change of it would go unnoticed."""

    def __init__(self, what: str):
        self.what = what
        super().__init__(f"{what} is read, but not among the declared needs")


class Evidence:
    """Results by name.

    Args:
        needs: what may be read.
    """

    def __init__(self, needs: Needs):
        self._needs, self._layout = needs, Layout(needs.root)

    @property
    def root(self) -> str:
        """The folder of its results."""
        return self._layout.root

    @property
    def study(self) -> str:
        """The study's name."""
        return self._layout.name

    @property
    def shipped(self) -> bool:
        """Whether the study is the one of the README."""
        return self.study == SHIPPED

    @property
    def facts(self) -> Mapping[str, JsonValue]:
        """All that is known of the study beside its results."""
        return self._needs.facts

    def fact(self, name: str) -> JsonValue:
        """One of the facts. Raises Undeclared."""
        if name not in self.facts:
            raise Undeclared(name)
        return self.facts[name]

    def _declared(self, path: str) -> str:
        if path not in self._needs.files:
            raise Undeclared(path)
        return path

    def _table(self, path: str) -> "pd.DataFrame":
        import pandas as pd

        read = pd.read_parquet if path.endswith(".parquet") else pd.read_csv
        return read(self._declared(path))

    def history(self, learner: str, scenario: str | None = None) -> "pd.DataFrame":
        """A row for each seed and measurement of a training.

        Args:
            learner: name of the training.
            scenario: the study's own unless given.
        """
        return self._table(self._layout.history(scenario or self.fact("scenario"), learner))

    def errors(self, learner: str, scenario: str | None = None, moment: str = "last") -> np.ndarray:
        """Position [cm] and orientation errors [degrees], last or first measurement.

        (search, seed, 2): the winner of each search with its seeds.
        """
        return errors_of(self.history(learner, scenario), moment)

    def ladder(self, learner: str) -> dict[int, np.ndarray]:
        """Final errors (search, seed, 2) for each number of iterations that it was trained for."""
        return {rung: self.errors(name) for rung, name in self.fact("ladder")[learner]}

    def ensemble(self, learner: str, series: str) -> "pd.DataFrame":
        """A row for each robot and scale of a series of other damages."""
        return self._table(self._layout.ensemble(series, learner))

    def mapping(self, name: str) -> "pd.DataFrame":
        """A measurement of the true mapping."""
        return self._table(self._layout.mapping(name))

    def assignments(self) -> "pd.DataFrame":
        """The initial errors of every assignment of the paper's damage."""
        from recalib.study.assignments import TIE

        table = self._table(self._layout.assignments(self.fact("robot")))
        return table.assign(distance=table["distance"].round(TIE))

    def nearest_assignment(self) -> "pd.Series":
        """The assignment that is used: the first of those that are nearest."""
        table = self.assignments()
        return table.loc[table["distance"].idxmin()]

    def sample(self, learner: str) -> "pd.DataFrame":
        """All trials of the searches for a training, a row each."""
        from recalib.study.experiments.samples import read_sample

        return read_sample(self._sample_path(learner))

    def searched_for(self, learner: str) -> jobs.Sample:
        """What the searches for a training could spend, and on what."""
        from recalib.study.experiments.samples import searched_for

        return searched_for(self._sample_path(learner))

    def _sample_path(self, learner: str) -> str:
        if learner not in self._needs.samples:
            raise Undeclared(f"the search for {learner}")
        return self._needs.samples[learner]

    def scenario(self, scenario: str | None = None) -> dict:
        """A damage as resolved."""
        return self._read(self._layout.scenario(scenario or self.fact("scenario")))

    def claims(self) -> list[dict]:
        """The judged claims."""
        return self._read(self._layout.claims)

    def _read(self, path: str):
        with open(self._declared(path), encoding="utf-8") as text:
            return json.load(text)

    def deviations(self) -> str:
        """The path of what changed after a result had been seen."""
        return self._declared(DEVIATIONS)

    def summary(self) -> "pd.DataFrame":
        """The first and the last errors of every training."""
        return self._table(self._layout.summary)

    def reference(self) -> "pd.DataFrame":
        """A row for each replicate of the reference study, measured as the setups are."""
        return self._table(self._layout.shipped(REFERENCE))

    def setups(self, table: str) -> "pd.DataFrame | None":
        """A row for each replicate of each alternative setup; None unless all are measured.

        Args:
            table: outcomes; or horizon, how long Ritter's takes.
        """
        import pandas as pd

        paths = pieces(table, self.fact("setups")[table], self._layout.shipped(SECOND))
        if not set(paths) & set(self._needs.files):
            return None
        return pd.concat(map(self._table, paths), ignore_index=True)

    def efforts(self) -> "pd.DataFrame":
        """A row for each training, effort, search, seed and measurement."""
        return self._table(self._layout.shipped(EFFORTS))

    def power(self) -> "pd.DataFrame":
        """What the campaign can find, in worlds whose truth is known."""
        return self._table(POWER)

    def first_campaign(self) -> "tuple[pd.DataFrame, pd.DataFrame]":
        """Design and outcomes of the first campaign, a row for each setup."""
        return self._table(f"{FIRST}/design.csv"), self._table(f"{FIRST}/outcomes.csv")

    def design(self) -> "pd.DataFrame":
        """The levels of each setup's factors."""
        return self.whole_design()[list(Factors.model_fields)]

    def whole_design(self) -> "pd.DataFrame":
        """A row for each setup, as `recalib.study.multiverse.design.Designed` has it."""
        return self._table(DESIGN)

    def benchmark(self) -> "pd.DataFrame":
        """Errors of every learner against moves."""
        return self._table(self._layout.benchmark)

    def benchmark_moves(self) -> "pd.DataFrame":
        """Moves to each threshold."""
        return self._table(self._layout.benchmark_moves)

    def real(self) -> "pd.DataFrame":
        """Errors on the real arm."""
        return self._table(self._layout.real)

    def rng(self, *keys: str) -> np.random.Generator:
        """Randomness of an interval."""
        return generator(self.fact("seed"), "evidence", *keys)
