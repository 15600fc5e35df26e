"""Section 7: the paper's Figure 1."""

from recalib.study.evidence.claims.across import Across
from recalib.study.evidence.claims.claim import Claim, Finding, Limit
from recalib.study.evidence.claims.remaining import both
from recalib.study.evidence.verdicts import Comparison
from recalib.study.inference.intervals import typical

LEFT = Limit(0.1)


def measure(evidence, limits):
    improved = evidence.facts["improved"]
    shares, errors = both(evidence, improved), evidence.errors(improved)
    final = errors[typical(errors)].mean(axis=0)
    return Finding(
        {"improved system": max(shares.values())} | shares,
        numbers={"final error [cm]": final[0], "final error [degrees]": final[1]},
        note="Final errors are those of the typical search. The published curve is no part of the"
        " text, so it is not compared.",
    )


CLAIM = Claim(
    id="figure-1",
    section="7",
    quotation="Figure 1 shows the results of performing 200 iterations with our learning system",
    statement="200 iterations make both errors small.",
    short="{percent} of the error remains",
    published="Figure 1, whose picture is not part of the text",
    limits={"left": LEFT},
    criterion="Both errors end below a {left:word} of the initial ones after {iterations}"
    " iterations.",
    reason="An order of magnitude is the least that a figure would show.",
    needs="runs/{scenario}/{improved}.parquet seed iterations",
    measure=measure,
    across={"improved system": Across("remaining", "larger remaining share", Comparison(LEFT))},
    figures=("figure1",),
)
