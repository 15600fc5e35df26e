"""Verdicts: what a number over all setups says of a claim. docs/registration.md has the rules.

They are symmetric: what a positive verdict needs, a negative one needs.
"""

from enum import StrEnum
from typing import NamedTuple

import numpy as np
from scipy.stats import beta

from replication.judgement.hierarchy import TAILS, Estimate, Model

SPREAD = float(np.log(1.2))  # between setups: a smaller one is no matter of which setup it is
MOST = 0.8  # of setups: if no verdict holds in so many, it depends on the setup
WIDEST = 4.0  # times the lowest of an interval, if a published number in it is to say something


class Verdict(StrEnum):
    """In a word."""

    SUPPORTED = "supported"
    CONTRADICTED = "contradicted"
    NO_EFFECT = "no effect"
    DEPENDS = "depends"
    UNDECIDED = "undecided"


class Comparison(NamedTuple):
    """What a number is compared with; numbers and limits are logarithms.

    Attributes:
        limit: between what the paper says and the opposite.
        below: whether the paper is right below the limit; above it otherwise.
        same: so far from the limit, there is no effect; 0 if the limit alone decides.
    """

    limit: float
    below: bool = True
    same: float = 0.0

    def verdict(self, its: Model) -> Verdict:
        """Of a number over all setups."""
        if its.heterogeneity.low > SPREAD and max(self.shares(its).values()) < MOST:
            return Verdict.DEPENDS
        return self.of_interval(its.mean)

    def of_interval(self, interval: Estimate) -> Verdict:
        """Of an interval: an effect lies all on one side of the limit, and is no small one."""
        mean, low, high = (value - self.limit for value in interval)
        if -self.same < low and high < self.same:
            return Verdict.NO_EFFECT
        if (high < 0 or low > 0) and abs(mean) >= self.same:
            return Verdict.SUPPORTED if (high < 0) == self.below else Verdict.CONTRADICTED
        return Verdict.UNDECIDED

    def shares(self, its: Model) -> dict[Verdict, float]:
        """Which share of setups has each effect, with luck taken out."""
        below, same, above = its.shares(self.limit - self.same, self.limit + self.same)
        right, wrong = (below, above) if self.below else (above, below)
        return {
            Verdict.SUPPORTED: right,
            Verdict.NO_EFFECT: same,
            Verdict.CONTRADICTED: wrong,
        }


# Of the ratio of two errors: a claim says that the first one is smaller; 10 % is the same.
RATIO = Comparison(0.0, same=float(np.log(1.1)))


def of_published(published: float, another: Estimate) -> Verdict:
    """Of a published number: one study on one robot lies in the interval of one more study.

    Both are logarithms. A wide interval agrees with anything.
    """
    if not another.low <= published <= another.high:
        return Verdict.CONTRADICTED
    narrow = another.high - another.low <= np.log(WIDEST)
    return Verdict.SUPPORTED if narrow else Verdict.UNDECIDED


def of_share(holds: int, setups: int) -> Verdict:
    """Of a claim about every setup: it holds in all, in most or in few of them."""
    low, _ = share_interval(holds, setups)
    if holds == setups and low >= MOST:
        return Verdict.SUPPORTED
    if holds == setups:
        return Verdict.UNDECIDED
    return Verdict.DEPENDS if 2 * holds > setups else Verdict.CONTRADICTED


def share_interval(holds: int, setups: int) -> tuple[float, float]:
    """The interval of a share (Clopper and Pearson)."""
    low = beta.ppf(TAILS[0], holds, setups - holds + 1) if holds else 0.0
    high = beta.ppf(TAILS[1], holds + 1, setups - holds) if holds < setups else 1.0
    return float(low), float(high)
