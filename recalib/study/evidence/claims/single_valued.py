"""Section 3: what the controller between learner and joints spares."""

from recalib.study.evidence.claims.claim import Claim, Finding, Limit
from recalib.study.evidence.verdicts import Verdict


def measure(evidence, limits):
    table = evidence.table("mapping/solutions.parquet")
    commands = table["commands"]
    single = (commands == limits["commands"]).all()
    angles = table["joint_solutions"]
    note = (
        f"{len(table):,} poses, each reached by {angles.mean():.1f} joint solutions on average and"
        f" by {angles.max()} at most."
    )
    return Finding(
        verdict=Verdict.SUPPORTED if single else Verdict.CONTRADICTED,
        numbers={"most commands": float(commands.max()), "fewest commands": float(commands.min())},
        note=note,
    )


CLAIM = Claim(
    id="single-valued",
    section="3",
    quotation="avoids the problem of the original application of having a multivalued inverse"
    " function, because the controller always chooses the same joint angles for a fixed command",
    statement="Many joint angles reach a pose, but only one command does.",
    short="{number} command for a pose",
    limits={"commands": Limit(1.0)},
    criterion="Of all joint angles found with which the damaged arm reaches a pose, the controller"
    " chooses exactly {commands:g} solution for the command that asks for it, at every pose of"
    " every scenario.",
    reason="For each pose, Newton's method from 50 random starts finds the joint angles.",
    needs="mapping/solutions.parquet",
    measure=measure,
)
