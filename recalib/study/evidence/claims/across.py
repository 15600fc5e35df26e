"""Verdicts over all universes: does a claim hold whatever one chooses where the paper is silent?

The rule was written down before the first universe was run.
"""

from typing import TYPE_CHECKING, NamedTuple

from recalib.study.statistics import LEVEL

if TYPE_CHECKING:
    import pandas as pd

MAJORITY = 0.5
RULE = (
    "Supported: it holds at home (whole interval), and in more than half of the universes (whole"
    " interval). Not supported: it is not shown at home, and it holds in less than half of the"
    " universes (whole interval). Undecided: anything else."
)


class Across(NamedTuple):
    """How a claim is measured in a universe: one number, compared with one of its limits.

    Attributes:
        column: of the table of outcomes.
        number: what is in it, in words.
        limit: name of the claim's limit.
        below: whether the claim holds below it; above it otherwise.
    """

    column: str
    number: str
    limit: str = "ratio"
    below: bool = True

    def holds(self, outcomes: "pd.DataFrame", limit: float) -> "pd.Series":
        """In which universes the claim holds."""
        values = outcomes[self.column]
        return values < limit if self.below else values > limit


class Share(NamedTuple):
    """In how many universes a claim holds.

    Attributes:
        holds, of: so many of so many.
        strongest: the row of `evidence.effects` for the factor that moves its number most.
    """

    holds: int
    of: int
    strongest: "pd.Series"

    @property
    def interval(self) -> tuple[float, float]:
        """Of the share among all universes that could have been drawn (Wilson)."""
        from scipy.stats import binomtest  # half a second, which only judging needs

        found = binomtest(self.holds, self.of).proportion_ci(LEVEL, "wilson")
        return float(found.low), float(found.high)

    @property
    def said(self) -> dict:
        """As the contract of claims.json has it."""
        its = self.strongest
        return {
            "holds": self.holds,
            "of": self.of,
            "interval": [_rounded(bound) for bound in self.interval],
            "depends_on": {
                "factor": its["factor"],
                "from": str(its["least"]),
                "to": str(its["largest"]),
                "times": _rounded(its["effect"]),
                "interval": [_rounded(its["low"]), _rounded(its["high"])],
                "chance": _rounded(its["chance"]),
            },
        }


def _rounded(value: float) -> float:
    return float(f"{value:.4g}")


def over_all(home: bool | None, share: Share | None) -> bool | None:
    """Whether a claim holds, by RULE: None where the data do not say."""
    if share is None:
        return home
    low, high = share.interval
    if home and low > MAJORITY:
        return True
    return False if not home and high < MAJORITY else None
