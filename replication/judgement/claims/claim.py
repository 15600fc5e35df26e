"""The claims of the paper as data, and how they are judged."""

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
import pandas as pd
from scipy.stats import f_oneway

from replication.config.shipped import FEWEST
from replication.judgement.contrasts import Estimand, Values
from replication.judgement.evidence import Evidence, NotMeasured
from replication.judgement.findings import Finding, Number, Spread, number, spread
from replication.judgement.hierarchy import LEVEL
from replication.judgement.verdicts import RATIO, Comparison, Verdict


@dataclass(frozen=True)
class Statement:
    """A statement in the paper, and the criterion that would support it."""

    id: str  # its name
    words: str  # a quotation from the paper
    claim: str  # the claim in one sentence
    criterion: str  # the condition that supports the claim
    reason: str  # why this criterion was chosen
    section: str = ""  # of the paper, if it is not only that of the file
    published: str | None = None  # the paper's number, if any

    def finding(
        self, verdict: Verdict, *estimates: Number, note: str = "", spread: Spread | None = None
    ) -> Finding:
        """The finding about this statement."""
        stated = {name: value for name, value in vars(self).items() if name in Finding.model_fields}
        found = {"verdict": verdict, "estimates": estimates, "note": note, "spread": spread}
        return Finding.model_validate({"statement": self.words} | stated | found)


@dataclass(frozen=True, kw_only=True)
class OfSetups(Statement):
    """A claim whose verdict depends on one number in all setups."""

    name: str  # name of the number
    system: str  # the algorithm that the paper describes
    estimand: Estimand  # the number
    comparison: Comparison = RATIO  # the limit with which the number is compared
    # further numbers, by name and system, without effect on the verdict
    secondary: Mapping[tuple[str, str], Estimand] = field(default_factory=dict)

    @property
    def registered(self) -> tuple[object, ...]:
        """Everything that determines the verdict, apart from registered files."""
        return self.words, self.criterion, self.estimand, self.comparison

    def judge(self, evidence: Evidence) -> Finding:
        """The finding. Raises NotMeasured if too few setups have the number."""
        values = self.values(evidence)
        model, setups = values.model(), values.table.index
        numbers = [number(self.name, self.system, model.mean, model.another)]
        for (name, system), estimand in self.secondary.items():
            secondary = estimand.values(evidence.outcomes()).model()
            numbers.append(number(name, system, secondary.mean, secondary.another))
        return self.finding(
            self.comparison.verdict(model),
            *numbers,
            spread=spread(
                model,
                values.unsettled,
                self.comparison.shares(model),
                strongest(model.numbers, evidence.levels().loc[setups]),
            ),
        )

    def values(self, evidence: Evidence) -> Values:
        """The number in each setup. Raises NotMeasured like `judge`."""
        values = self.estimand.values(evidence.outcomes())
        if not enough(values):
            raise TooFewSetups(self.name)
        return values


def strongest(numbers: np.ndarray, levels: pd.DataFrame) -> str | None:
    """The factor with the strongest effect on a number, if it is significant; otherwise None.

    The analysis of variance has a level of 5 % over all factors (Bonferroni). The design is
    balanced, so the other factors average out in the analysis of one factor.

    Args:
        numbers: (setup,) on the scale on which they are averaged.
        levels: (setup, factor) the levels.
    """
    chances = {}
    for factor, level in levels.items():
        groups = [numbers[level == name] for name in level.unique()]
        several = [group for group in groups if len(group) > 1]
        chances[factor] = f_oneway(*several).pvalue if len(several) > 1 else 1.0
    least = min(chances, key=lambda factor: chances[factor])
    return str(least) if chances[least] * len(chances) < 1 - LEVEL else None


class TooFewSetups(NotMeasured):
    """The campaign has measured a number in too few setups for a verdict."""


def enough(values: Values) -> bool:
    """Whether there can be a verdict: enough setups, and at least one with two replicates."""
    counts = np.isfinite(values.table).sum(axis=1)
    return len(counts) >= FEWEST and bool(counts.max() > 1)


@dataclass(frozen=True, kw_only=True)
class Measured(Statement):
    """A claim about the mapping, or about the reference study alone."""

    judge_: Callable[[Statement, Evidence], Finding]

    @property
    def registered(self) -> tuple[object, ...]:
        """Everything that determines the verdict, apart from registered files."""
        return self.words, self.criterion, inspect.getsource(self.judge_)

    def judge(self, evidence: Evidence) -> Finding:
        """The finding. Raises NotMeasured."""
        return self.judge_(self, evidence)


Claim = OfSetups | Measured


def of_all(*verdicts: Verdict) -> Verdict:
    """The verdict on a claim with several parts: that of the first part that is not supported."""
    unsupported = (verdict for verdict in verdicts if verdict is not Verdict.SUPPORTED)
    return next(unsupported, Verdict.SUPPORTED)


def log(limit: float) -> float:
    """The natural logarithm of a limit."""
    return float(np.log(limit))
