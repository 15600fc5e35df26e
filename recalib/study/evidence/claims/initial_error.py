"""Section 7: the paper's damage and its initial errors."""

from recalib.study.evidence.claims.claim import Claim, Finding, Limit
from recalib.study.evidence.verdicts import Verdict
from recalib.study.inference.measured import ERRORS

NEAR = 0.05  # of both published errors


def measure(evidence, limits):
    table, published = evidence.assignments(), evidence.facts["published"]
    below = {
        f"share of assignments below {published[error]:g} {error.split('_')[-1]}": float(
            (table[error] < published[error]).mean()
        )
        for error in ERRORS
    }
    nearest = evidence.nearest_assignment()
    note = (
        f"Of {len(table):,} assignments, {int((table['distance'] <= NEAR).sum())} are within"
        f" {100 * NEAR:g} % of both; the nearest gives {nearest[ERRORS[0]]:.2f} cm and"
        f" {nearest[ERRORS[1]]:.2f} degrees. The home of the robot was chosen so that such errors"
        " occur, so this says that they are possible, not that they are likely."
    )
    holds = all(limits["tail"] <= share <= 1 - limits["tail"] for share in below.values())
    verdict = Verdict.SUPPORTED if holds else Verdict.CONTRADICTED
    return Finding(verdict=verdict, numbers=below, note=note)


CLAIM = Claim(
    id="initial-error",
    section="7",
    quotation="the initial mean average position and orientation error, when executing (1), was 8.3"
    " cm and 4.7 degrees, respectively",
    statement="This damage gives initial errors of {published[position_error_cm]} cm and"
    " {published[orientation_error_deg]} degrees.",
    short="{percent} of such damages give a smaller position error",
    published="{published[position_error_cm]} cm, {published[orientation_error_deg]} degrees",
    limits={"tail": Limit(0.025)},
    criterion="Both published errors lie inside the central {tail:central} of those of all"
    " assignments of the damage on our robot.",
    reason="Robot, links, encoders and signs are not published, so only plausibility can be"
    " tested.",
    needs="assignments/{robot}.parquet published",
    measure=measure,
    figures=("figure10",),
)
