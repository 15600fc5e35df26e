"""Section 3: Ritter's algorithm as it is."""

from recalib.study.evidence.claims.claim import Claim, Finding, Limit
from recalib.study.evidence.claims.shares import both_left


def needs(ask):
    ask.history(ask.fact("short"))
    for fact in ("iterations", "seed"):
        ask.fact(fact)


def measure(evidence, limits):
    estimates = both_left(evidence, evidence.fact("short"))
    return Finding.of(all(each.low > limits["left"] for each in estimates.values()), estimates)


CLAIM = Claim(
    id="ritter-slow",
    section="3",
    statement="Ritter's algorithm on a fixed grid is not as quick as expected, even with its widths"
    " tuned.",
    published="no number",
    limits={"left": Limit(0.25)},
    criterion="After {iterations} iterations, tuned for them, both errors are still above"
    " a {left:word} of the initial ones (lower ends).",
    reason="The paper shows 200 iterations of its improvement; a learner that keeps a {left:word}"
    " of the error there is not quick.",
    needs=needs,
    measure=measure,
    figures=("figure9",),
)
