"""Section 4: positions and orientations apart."""

from recalib.study.evidence.claims.across import Across
from recalib.study.evidence.claims.claim import Claim, Limit
from recalib.study.evidence.verdicts import Comparison

RATIO = Limit(0.1)

CLAIM = Claim(
    id="weak-coupling",
    section="4",
    quotation="changes in position coordinates influence very slowly the orientation commands, and"
    " the same can be said about orientation coordinates with respect to position commands",
    statement="Positions hardly influence orientation commands, nor the reverse.",
    short="at 95 % of poses, at most {percent} of the effect of their own coordinates",
    limits={"ratio": RATIO, "poses": Limit(0.95)},
    criterion="At {poses:percent} of the poses of every scenario, the off-diagonal blocks of the"
    " true mapping's Jacobian have at most a {ratio:word} of the norm of the diagonal ones.",
    reason="Hardly is an order of magnitude.",
    across={"the mapping": Across("coupling", "off-diagonal over diagonal", Comparison(RATIO))},
    figures=("figure5",),
)
