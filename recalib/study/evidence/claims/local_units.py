"""Section 8: other local units."""

from recalib.study.evidence.claims.across import Across
from recalib.study.evidence.claims.claim import Claim

CLAIM = Claim(
    id="local-units",
    section="8",
    quotation="other neural network algorithms based on local units can also benefit from these"
    " improvements",
    statement="Other networks of local units gain by sharing changes, too.",
    short="error x {number}",
    criterion="The error of radial units that share increments of their commands over that of"
    " those that share values is below 1, both tuned.",
    reason="Radial units without Jacobians are the simplest other kind of local unit.",
    across={"radial units": Across("radial", "error with increments / with values")},
)
