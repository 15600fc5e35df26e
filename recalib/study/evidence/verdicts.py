"""Verdicts: what an interval says of a claim. The rules stand in docs/registration.md.

They are symmetric: what a positive verdict needs, a negative one needs.
"""

from enum import StrEnum
from typing import NamedTuple

from recalib.study.inference.intervals import Estimate

WIDEST = 4  # times the lowest of an interval, if a published number inside it is to say something


class Verdict(StrEnum):
    """In a word."""

    SUPPORTED = "supported"
    CONTRADICTED = "contradicted"
    NO_EFFECT = "no effect"
    UNDECIDED = "undecided"


class Comparison(NamedTuple):
    """What a number is compared with.

    Attributes:
        limit: between what the paper says and the opposite.
        below: whether the paper is right below the limit; above it otherwise.
        bounds: of equivalence: between them there is no effect. None where a limit decides.
    """

    limit: float
    below: bool = True
    bounds: tuple[float, float] | None = None

    def side(self, estimate: Estimate) -> Verdict:
        """On which side of the limit the whole interval lies: undecided where it holds the limit.

        An interval that is not known decides nothing.
        """
        if estimate.high < self.limit:
            return Verdict.SUPPORTED if self.below else Verdict.CONTRADICTED
        if estimate.low > self.limit:
            return Verdict.CONTRADICTED if self.below else Verdict.SUPPORTED
        return Verdict.UNDECIDED

    def verdict(self, estimate: Estimate) -> Verdict:
        """Of one interval."""
        if self.bounds and self.bounds[0] < estimate.low and estimate.high < self.bounds[1]:
            return Verdict.NO_EFFECT
        return self.side(estimate)

    def over_all(self, mean: Estimate, reference: Estimate) -> Verdict:
        """Of the mean over the alternative setups, unless the reference study says the opposite."""
        found, opposite = self.verdict(mean), self.side(reference)
        decided = {Verdict.SUPPORTED, Verdict.CONTRADICTED}
        return Verdict.UNDECIDED if {found, opposite} == decided else found


RATIO = Comparison(1.0, bounds=(1 / 1.1, 1.1))
CORRELATION = Comparison(0.0, below=False, bounds=(-0.1, 0.1))


def of_published(published: float, estimate: Estimate) -> Verdict:
    """Of a published number above zero. A bound at the end of a ladder is infinite."""
    if not estimate.low <= published <= estimate.high:
        known = estimate.low <= estimate.high  # neither is NaN
        return Verdict.CONTRADICTED if known else Verdict.UNDECIDED
    narrow = estimate.high <= WIDEST * estimate.low
    return Verdict.SUPPORTED if narrow else Verdict.UNDECIDED
