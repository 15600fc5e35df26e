"""What the pages of a study show: results as objects, from which templates choose."""

import re
from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from replication.campaign.variants import DOUBLE, variants
from replication.config.shipped import HALFWAY, root_of
from replication.config.study import Study
from replication.config.switches import IMPROVED
from replication.judgement.checks import KEYS as TRAINING
from replication.judgement.claims import claims
from replication.judgement.claims.claim import Claim, OfSetups, Statement, TooFewSetups
from replication.judgement.contrasts import KEYS, Crossing, Remaining
from replication.judgement.deviations import Deviations
from replication.judgement.evidence import Evidence, NotMeasured
from replication.judgement.findings import Finding, Number, number
from replication.judgement.hierarchy import Estimate
from replication.judgement.verdicts import Verdict
from replication.pages.choices import Choice, factor, read_choices
from replication.pages.formats import estimate, interval, percent, short
from replication.pages.guidance import Benchmark
from replication.pages.imprint import Imprint
from replication.plots.figures import Figure
from replication.training.competitors import label_of
from replication.training.measured import ERRORS, KINDS, UNITS

NOT_MEASURED = "not measured"
SYSTEMS = {IMPROVED: "improved system"}


@dataclass(frozen=True)
class Judged:
    """A claim and its finding."""

    statement: Statement  # what the paper says
    finding: Finding | None  # None if it was not measured
    needs: str  # what would measure it if nothing has, unless it is the campaign
    changed: bool  # whether its criterion changed after a result had been seen
    # names and systems of those of its numbers that are shares of an error
    shares: frozenset[tuple[str, str]]

    @property
    def verdict(self) -> str:
        """In a word or two."""
        return str(self.finding.verdict) if self.finding else NOT_MEASURED

    @property
    def exploratory(self) -> bool:
        """Whether a result preceded the criterion: all but those of the campaign did."""
        return self.changed or (self.finding is not None and self.finding.spread is None)

    @property
    def slug(self) -> str:
        """The anchor of its heading."""
        return re.sub(r"[^a-z0-9 -]", "", self.statement.claim.lower()).replace(" ", "-")

    @property
    def number(self) -> Number | None:
        """The one that decides."""
        return self.finding.estimates[0] if self.finding else None

    @property
    def value(self) -> str:
        """That number with its interval."""
        return self.text(self.number) if self.number else NOT_MEASURED

    @property
    def result(self) -> str:
        """That number with its name."""
        return f"{_named(self.number.name)}: {self.value}" if self.number else self.value

    def of_system(self, system: str) -> Number | None:
        """Its number for another algorithm, if it has one."""
        numbers = self.finding.estimates if self.finding else ()
        return next((number for number in numbers if number.system == system), None)

    def name(self, number: Number, before: Number | None = None) -> str:
        """What a number is, and of which algorithm if it is another one than that before."""
        name = _named(number.name)
        if not number.system or (before and before.system == number.system):
            return name
        return f"{name} ({SYSTEMS.get(number.system, number.system)})"

    def text(self, number: Number) -> str:
        """A number with its interval."""
        return estimate(number, self._form(number))

    def predicted(self, number: Number) -> str:
        """The interval of one more study."""
        assert number.predictive_interval
        return interval(number.predictive_interval, self._form(number))

    def _form(self, number: Number) -> Callable[[float], str]:
        return percent if (number.name, number.system) in self.shares else short


class Contents:
    """Everything that a template can show, computed when a page asks. `figures` are files."""

    def __init__(self, study: Study, figures: Iterable[Path] = (), project: Path = Path()):
        self.study, self.project = study, project
        drawn = {path.stem for path in figures}
        self.figures = [figure for figure in Figure if figure.file in drawn]
        self.evidence = Evidence(study, project)
        self.root = root_of(study.name)

    @cached_property
    def claims(self) -> dict[str, Judged]:
        """All claims in the paper's order, by their ids."""
        found = self.evidence.findings()
        return {claim.id: self._judged(claim, found.get(claim.id)) for claim in claims(self.study)}

    def _judged(self, claim: Claim, finding: Finding | None) -> Judged:
        numbers = {}
        if isinstance(claim, OfSetups):
            numbers = {(claim.name, claim.system): claim.estimand, **claim.secondary}
        shares = frozenset(key for key in numbers if isinstance(numbers[key], Remaining))
        needs = "" if finding else self._needs(claim)
        changed = any(
            change.kind == "criterion" and claim.id in change.digests
            for change in self.deviations.deviations
        )
        return Judged(claim, finding, needs, changed, shares)

    def _needs(self, claim: Claim) -> str:
        try:
            claim.judge(self.evidence)
        except NotMeasured as error:
            if not isinstance(error, TooFewSetups):
                return f"`{error}`"
        return ""

    @cached_property
    def verdicts(self) -> dict[str, list[Judged]]:
        """The claims by their verdicts; those that were not measured come last."""
        found: dict[str, list[Judged]] = {name: [] for name in map(str, Verdict)}
        for claim in self.claims.values():
            found.setdefault(claim.verdict, []).append(claim)
        return {name: claims for name, claims in found.items() if claims}

    @cached_property
    def setups(self) -> int:
        """Setups of the campaign in which every variant has been measured."""
        names = {name for name, variant in variants(self.study).items() if variant.lengths}
        try:
            measured = self.evidence.outcomes().groupby("setup")["variant"].agg(set)
        except NotMeasured:
            return 0
        return int(measured.map(names.issubset).sum())

    @cached_property
    def replicates(self) -> int:
        """Measurements of a variant for one number of iterations: setups, some of them twice."""
        return self.evidence.outcomes().groupby(KEYS).ngroups

    @cached_property
    def unconverged(self) -> float:
        """The share of tuned variants whose two searches have not converged."""
        outcomes = self.evidence.outcomes()
        rough = [name for name, variant in variants(self.study).items() if variant.rough]
        return float(1 - outcomes.loc[~outcomes["variant"].isin(rough), "settled"].mean())

    @cached_property
    def halfway(self) -> Number:
        """Of how many times as many iterations Ritter's map needs, with `halfway` in each setup."""
        goal = Remaining(IMPROVED, self.study.experiments.iterations)
        more = self.evidence.table(HALFWAY)
        outcomes = pd.concat([self.evidence.outcomes(), more])
        found = Crossing(DOUBLE, goal).values(outcomes).model()
        return number("", "", found.mean, found.another)

    def counts(self, claim: Judged) -> dict[str, int]:
        """In how many setups each effect was measured, of a claim that setups decide."""
        statement, numbers = self._numbers(claim)
        effect = statement.comparison.of_interval
        found = Counter(str(effect(Estimate(*[number] * 3))) for number in numbers)
        shares = claim.finding.spread.shares if claim.finding and claim.finding.spread else {}
        return {verdict: found[verdict] for verdict in shares}

    def levels(self, claim: Judged) -> dict[str, float]:
        """The mean at each level of the choice that moves a number most."""
        assert claim.finding and claim.finding.spread and claim.finding.spread.factor
        levels = self.evidence.levels()[claim.finding.spread.factor]
        means = self._numbers(claim)[1].groupby(levels).mean()
        return {str(level): float(np.exp(mean)) for level, mean in means.items()}

    def _numbers(self, claim: Judged) -> tuple[OfSetups, pd.Series]:
        """The logarithm of a claim's number in each setup."""
        assert isinstance(claim.statement, OfSetups)
        values = claim.statement.values(self.evidence)
        return claim.statement, pd.Series(values.model().numbers, values.table.index)

    @cached_property
    def own(self) -> dict[str, Any]:
        """The row of the improved system in the summary, for Figure 1."""
        study, table = self.study, self.evidence.table("summary.csv").set_index(TRAINING)
        iterations = study.experiments.iterations
        return table.loc[study.robot, study.scenario, IMPROVED, iterations].to_dict()

    @cached_property
    def errors(self) -> list[dict[str, str]]:
        """Errors of the main learners on the study's own robot and scenario, in words."""
        table = self.evidence.table("summary.csv")
        own = (table["robot"] == self.study.robot) & (table["scenario"] == self.study.scenario)
        main = self.study.experiments.learners
        return [
            {
                "learner": label_of(row["learner"]),
                "iterations": short(row["iterations"]),
                "before": _pair(row, "initial"),
                "after": _pair(row, "final"),
            }
            for row in table[own].to_dict("records")
            if row["iterations"] in main.get(row["learner"], ())
        ]

    @cached_property
    def damages(self) -> list[str]:
        """The damages of the study's scenario as resolved: "link forearm_link, shorten 4 cm"."""
        return [_words(entry) for entry in self.evidence.scenario()["damages"]]

    @cached_property
    def choices(self) -> dict[str, Choice]:
        """Keys of config.yaml with their values and reasons."""
        return read_choices(self.project / "config.yaml")

    @cached_property
    def alternatives(self) -> list[Choice]:
        """The factors of the campaign with their levels; the reference study's comes first."""
        return [
            Choice(
                factor(name),
                tuple(str(level).replace("_", " ") for level in levels),
                self.choices[f"campaign.factors.{name}"].reason,
            )
            for name, levels in self.study.campaign.factors
        ]

    def factor(self, name: str) -> str:
        """What a factor of the campaign is, within a sentence."""
        text = factor(name)
        return text[0].lower() + text[1:]

    @cached_property
    def deviations(self) -> Deviations:
        """What changed after a result had been seen."""
        return Deviations.read(self.project)

    @cached_property
    def imprint(self) -> Imprint:
        """Authors and address of the project."""
        return Imprint.read(self.project)

    @cached_property
    def benchmark(self) -> Benchmark:
        """What one should use today. Raises NotMeasured."""
        tables = map(self.evidence.table, ("benchmark.csv", "benchmark_moves.csv"))
        return Benchmark(self.study.benchmark, *tables)


def _named(name: str) -> str:
    """The name of a number, with columns in words."""
    for error, kind, unit in zip(ERRORS, KINDS, UNITS, strict=True):
        name = name.replace(error, f"{kind} error [{unit}]")
    return name


def _pair(row: Mapping[str, Any], moment: str) -> str:
    """Both errors of a row of the summary, before or after learning."""
    errors = (row[f"{moment}_{error}"] for error in ERRORS)
    return ", ".join(f"{short(value)} {unit}" for value, unit in zip(errors, UNITS, strict=True))


def _words(entry: Mapping[str, Any]) -> str:
    """A damage in the words of the configuration."""
    return ", ".join(
        f"{key} {' '.join(value) if isinstance(value, list) else value}"
        for key, value in entry.items()
    )
