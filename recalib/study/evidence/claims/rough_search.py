"""Section 7: how the parameters were found."""

from recalib.study.evidence.claims.across import Across
from recalib.study.evidence.claims.claim import Claim, Limit
from recalib.study.evidence.verdicts import Comparison

LEFT = Limit(0.1)


CLAIM = Claim(
    id="rough-search",
    section="7",
    quotation="The parameters were selected after a very rough search",
    statement="A very rough search finds the parameters.",
    short="{percent} remains after the best of 16 random trials",
    limits={"left": LEFT},
    criterion="With the best of {rough_trials} quasi-random trials, both errors end below"
    " a {left:word} of the initial ones.",
    reason="Figure 1, whose parameters were found so, has the same criterion.",
    needs="rough_trials",
    across={
        "improved system": Across("remaining_rough", "larger remaining share", Comparison(LEFT))
    },
    figures=("figure6",),
)
