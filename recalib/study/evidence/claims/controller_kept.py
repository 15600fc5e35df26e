"""Section 8: nothing but the controller's commands and poses."""

from recalib.study.evidence.claims.claim import Claim, Finding, Limit


def needs(ask):
    ask.mapping("replay")


def measure(evidence, limits):
    table = evidence.mapping("replay")
    difference = float(table["difference"].max())
    note = f"{len(table)} arrays compared."
    return Finding(
        difference <= limits["difference"], {"largest difference": difference}, note=note
    )


CLAIM = Claim(
    id="controller-kept",
    section="8",
    statement="The method works on top of the controller, which is not substituted.",
    short="It works on top of a controller that nobody changes: difference {}",
    published="no number",
    limits={"difference": Limit(0.0)},
    criterion="Fed with a table of commands and measured poses instead of a robot, the learner"
    " learns bit for bit the same.",
    reason="Then nothing else can have reached it.",
    needs=needs,
    measure=measure,
)
