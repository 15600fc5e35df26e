"""Section 3: Ritter's algorithm as it is."""

from recalib.study.evidence.claims.across import Across
from recalib.study.evidence.claims.claim import Claim, Finding, Limit
from recalib.study.evidence.claims.remaining import both
from recalib.study.evidence.verdicts import Comparison

LEFT = Limit(0.25)


def measure(evidence, limits):
    shares = both(evidence, evidence.facts["short"])
    return Finding({"Ritter's": min(shares.values())} | shares)


CLAIM = Claim(
    id="ritter-slow",
    section="3",
    quotation="was not as quick as expected, even if the neighborhood widths were tuned in order to"
    " maximize learning speed",
    statement="Ritter's map is slow, even with its widths tuned.",
    short="{percent} of its initial error remains",
    limits={"left": LEFT},
    criterion="After {iterations} iterations, tuned for them, both errors are still above"
    " a {left:word} of the initial ones.",
    reason="A learner that keeps a {left:word} of the error is not quick. A map that"
    " starts at random has larger initial errors than the uncorrected arm.",
    needs="runs/{scenario}/{short}.parquet iterations seed",
    measure=measure,
    across={
        "Ritter's": Across(
            "remaining_ritter", "smaller remaining share", Comparison(LEFT, below=False)
        )
    },
    figures=("figure9",),
)
