"""Section 8: conclusions."""

from replication.judgement.claims.claim import Measured, OfSetups, Statement
from replication.judgement.contrasts import Contrast, Remaining
from replication.judgement.evidence import Evidence
from replication.judgement.findings import Finding, Number
from replication.judgement.verdicts import Verdict


def controller_kept(statement: Statement, evidence: Evidence) -> Finding:
    """Whether a learner learns the same from a table of moves as from the robot."""
    table = evidence.mapping("replay")
    difference = float(table["difference"].max())
    return statement.finding(
        Verdict.SUPPORTED if difference == 0 else Verdict.CONTRADICTED,
        Number(name="largest difference between both runs", system="", value=difference),
        note=f"All {len(table)} learned arrays were compared.",
    )


def claims(iterations: int) -> list[OfSetups | Measured]:
    """The claims of the section, in its order; `iterations` are those of Figure 1."""
    return [
        Measured(
            "controller-kept",
            "the system can work without substituting the original controller in commercial robots",
            "The robot's controller stays as it is.",
            "Fed with a table of commands and measured poses instead of a robot, the learner"
            " learns bit for bit the same.",
            "Then it has learned from nothing else.",
            judge_=controller_kept,
        ),
        OfSetups(
            "local-units",
            "other neural network algorithms based on local units can also benefit from these"
            " improvements",
            "Another network of local units gains by sharing changes, too.",
            f"After {iterations} iterations the error of radial units that share increments of"
            " their commands is below that of those that share values.",
            "Radial units without Jacobians are one other kind of local unit, the simplest.",
            name="error with increments / with values",
            system="radial units",
            estimand=Contrast(
                Remaining("radial_increments", iterations), Remaining("radial_values", iterations)
            ),
        ),
    ]
