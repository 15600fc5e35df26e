"""Section 7: the paper's Figure 1."""

from recalib.study.evidence.claims.across import Across
from recalib.study.evidence.claims.claim import Claim, Finding, Limit, below, every
from recalib.study.evidence.claims.shares import both_left
from recalib.study.statistics import typical


def needs(ask):
    ask.history(ask.fact("improved"))
    ask.fact("seed")


def measure(evidence, limits):
    improved = evidence.fact("improved")
    estimates = both_left(evidence, improved)
    errors = evidence.errors(improved)
    final = errors[typical(errors)].mean(axis=0)
    holds = every(below(each, limits["left"]) for each in estimates.values())
    last = {"final cm": final[0], "final degrees": final[1]}
    return Finding.of(holds, estimates, "Final errors: those of the typical search.", **last)


CLAIM = Claim(
    id="figure-1",
    section="7",
    statement="200 iterations of the improved system with 3 x 3 x 3 nets, measured every 4"
    " iterations on 200 random poses, reduce both errors from their initial values to small ones.",
    short="Both errors become small: {} left",
    published="Figure 1, whose picture is not part of the text",
    limits={"left": Limit(0.1)},
    criterion="Both errors end below a {left:word} of the initial ones (whole intervals).",
    reason="The curves cannot be compared number by number; an order of magnitude is the least that"
    " a figure would show.",
    needs=needs,
    measure=measure,
    across={"": Across("left", "larger share left", "left")},
    figures=("figure1",),
)
