"""A claim over all alternative setups: mean, heterogeneity and luck of its number."""

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from recalib.study.evidence.verdicts import RATIO, Comparison, Verdict
from recalib.study.inference.hierarchy import Hierarchy, hierarchy, student
from recalib.study.inference.intervals import Estimate

if TYPE_CHECKING:
    import pandas as pd

FEWEST = 3  # setups with a number: fewer have no mean and heterogeneity
CLEAR = 3  # times the luck of a setup's number: farther away, a count of setups says something


class Across(NamedTuple):
    """How a claim is measured in a setup.

    Attributes:
        column: of the tables of the campaign.
        number: what is in it, in words.
        comparison: what it is compared with.
        logarithmic: whether it is a ratio, or another number above zero; a correlation otherwise.
        table: of the campaign, in which the column is.
    """

    column: str
    number: str
    comparison: Comparison = RATIO
    logarithmic: bool = True
    table: str = "outcomes"

    def values(self, table: "pd.DataFrame") -> "pd.Series":
        """Of a table, in the scale in which they are averaged."""
        return np.log(table[self.column]) if self.logarithmic else table[self.column]

    def limit(self) -> float:
        """The limit in that scale."""
        return float(np.log(self.comparison.limit)) if self.logarithmic else self.comparison.limit

    def back(self, estimate: Estimate) -> Estimate:
        """An estimate in that scale as a number."""
        return Estimate(*np.exp(estimate).tolist()) if self.logarithmic else estimate

    def in_reference(self, reference: "pd.DataFrame") -> Estimate:
        """The mean over the replicates of the reference study, with Student's interval."""
        return self.back(student(self.values(reference).to_numpy()))

    def over(self, outcomes: "pd.DataFrame", design: "pd.DataFrame") -> "Setups | None":
        """What all setups say, but for those with a bound in place of a number.

        None where fewer than FEWEST have a number: no mean is known.

        Args:
            outcomes: a row for each replicate of each setup.
            design: (setup, factor) levels.
        """
        table = outcomes.assign(value=self.values(outcomes))
        if "bound" in table:
            table["value"] = table["value"].where(table["bound"] == 0)
        everywhere = table.pivot(index="universe", columns="replicate", values="value")
        values = everywhere.dropna()
        if len(values) < FEWEST:
            return None
        levels = design.loc[values.index]
        model = hierarchy(values.to_numpy(), levels["effort"].to_numpy())
        return Setups(self, model, levels, len(everywhere) - len(values))


class Setups(NamedTuple):
    """A claim in all setups, with the levels (setup, factor) of their choices.

    `left_out` counts those with a bound, which are in none of its numbers.
    """

    across: Across
    model: Hierarchy
    levels: "pd.DataFrame"
    left_out: int

    @property
    def mean(self) -> Estimate:
        """Over the setups."""
        return self.across.back(self.model.mean)

    def verdict(self, reference: Estimate) -> Verdict:
        """Of the mean over the setups, unless the reference study says the opposite."""
        return self.across.comparison.over_all(self.mean, reference)

    @property
    def holds(self) -> tuple[int, float] | None:
        """In how many setups it holds, and in how many luck alone would let it hold by the mean.

        None where luck is not small beside the distance of the mean from the limit.
        """
        from scipy.special import ndtr

        sign = 1 if self.across.comparison.below else -1
        margins = sign * (self.across.limit() - self.model.numbers)
        distance = sign * (self.across.limit() - self.model.mean.mean)
        luck = self.model.luck_of_numbers
        if abs(distance) <= CLEAR * luck.max():
            return None
        with np.errstate(divide="ignore"):
            return int((margins > 0).sum()), float(ndtr(distance / luck).sum())

    def effects(self, random: np.random.Generator) -> "pd.DataFrame":
        """How much each choice moves the number: see `recalib.study.evidence.effects`."""
        from recalib.study.evidence.effects import effects

        table = effects(self.model.numbers, self.levels, random)
        if self.across.logarithmic:
            numbers = ["effect", "low", "high", "chance"]
            table[numbers] = np.exp(table[numbers])
        return table

    def said(self, random: np.random.Generator) -> dict:
        """As the contract of claims.json has it; `random` is of what choices do."""
        strongest = self.effects(random).iloc[0]
        found = {
            "status": "measured",
            "setups": len(self.model.numbers),
            "setups_left_out": self.left_out,
            "mean": rounded(self.mean.mean),
            "mean_interval": [rounded(bound) for bound in self.mean[1:]],
        }
        for name in ("heterogeneity", "luck"):
            estimate = getattr(self.model, name)
            found[name] = rounded(estimate.mean)
            found[f"{name}_interval"] = [rounded(bound) for bound in estimate[1:]]
        another = self.across.back(self.model.another)
        found["another_setup"] = [rounded(bound) for bound in another[1:]]
        if (counted := self.holds) is not None:
            found["holds"], found["holds_by_luck_alone"] = counted[0], rounded(counted[1])
        return found | {
            "depends_on": {
                "factor": strongest["factor"],
                "from": str(strongest["least"]),
                "to": str(strongest["largest"]),
                "effect": rounded(strongest["effect"]),
                "interval": [rounded(strongest["low"]), rounded(strongest["high"])],
                "chance": rounded(strongest["chance"]),
            },
        }


CANNOT_VARY = {"status": "cannot vary"}  # no choice of the project reaches it
NOT_MEASURED = {"status": "not measured"}  # a choice might, and nobody looked
NO_MEAN = {"status": "bounds instead of numbers, so no mean is known"}


def rounded(value: float) -> float:
    """With so many more digits than pages show that rounding twice is rounding once."""
    return float(f"{value:.6g}")
