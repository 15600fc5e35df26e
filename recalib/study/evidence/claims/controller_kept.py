"""Section 8: nothing but the controller's commands and poses."""

from recalib.study.evidence.claims.claim import Claim, Finding, Limit
from recalib.study.evidence.verdicts import Verdict


def measure(evidence, limits):
    table = evidence.table("mapping/replay.parquet")
    difference = float(table["difference"].max())
    return Finding(
        verdict=Verdict.SUPPORTED if difference <= limits["difference"] else Verdict.CONTRADICTED,
        numbers={"largest difference": difference},
        note=f"{len(table)} learned arrays are compared.",
    )


CLAIM = Claim(
    id="controller-kept",
    section="8",
    quotation="the system can work without substituting the original controller in commercial"
    " robots",
    statement="The robot's controller stays as it is.",
    short="difference {number} to learning from recorded moves",
    limits={"difference": Limit(0.0)},
    criterion="Fed with a table of commands and measured poses instead of a robot, the learner"
    " learns bit for bit the same.",
    reason="Then it has learned from nothing else.",
    needs="mapping/replay.parquet",
    measure=measure,
)
