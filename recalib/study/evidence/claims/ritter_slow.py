"""Section 3: Ritter's algorithm as it is."""

from recalib.study.evidence.claims.across import Across
from recalib.study.evidence.claims.claim import Claim, Finding, Limit, above, every
from recalib.study.evidence.claims.shares import both_left


def needs(ask):
    ask.history(ask.fact("short"))
    for fact in ("iterations", "seed"):
        ask.fact(fact)


def measure(evidence, limits):
    estimates = both_left(evidence, evidence.fact("short"))
    holds = every(above(each, limits["left"]) for each in estimates.values())
    return Finding.of(holds, estimates)


CLAIM = Claim(
    id="ritter-slow",
    section="3",
    statement="Ritter's algorithm on a fixed grid is not as quick as expected, even with its widths"
    " tuned.",
    short="Ritter's map learns slowly, however tuned: {} left",
    published="no number",
    limits={"left": Limit(0.25)},
    criterion="After {iterations} iterations, tuned for them, both errors are still above"
    " a {left:word} of the initial ones (whole intervals).",
    reason="The paper shows 200 iterations of its improvement; a learner that keeps a {left:word}"
    " of the error there is not quick.",
    needs=needs,
    measure=measure,
    across={"": Across("ritter_left", "smaller share left", "left", below=False)},
    figures=("figure9",),
)
