"""Section 5: what to propagate to neighbouring cells."""

from collections.abc import Callable
from functools import partial

import pandas as pd

from replication.config.switches import IMPROVED, RITTER
from replication.judgement.claims.claim import Measured, OfSetups, Statement
from replication.judgement.contrasts import Contrast, Difference, Remaining
from replication.judgement.evidence import Evidence
from replication.judgement.findings import Finding, Number
from replication.judgement.verdicts import RATIO, Verdict

EQUAL = 1 - 1e-6  # nearer to 1, two means differ by rounding
OFTEN = 0.95  # of the balls
SYSTEM = "improved system"


def integral_ratios(table: pd.DataFrame) -> pd.Series:
    """E_upd / E_clas for each kind, start and scale of propagation: the median over the balls.

    Scales at which a pose of some ball has no command are left out: the balls that remain would be
    the easy ones.
    """
    balls = table.assign(ratio=table["updated"] / table["classic"]).groupby(
        ["kind", "start", "scale"]
    )["ratio"]
    return balls.median()[balls.count() == balls.size()]


def nearer(kind: str) -> Callable[[Statement, Evidence], Finding]:
    """How to judge the paper's condition for what is propagated: theta or jacobian."""

    def judge(statement: Statement, evidence: Evidence) -> Finding:
        balls = evidence.mapping("propagation")
        tried = balls[balls["kind"] == kind]
        table = tried.dropna()
        meets = table["to_original"] < EQUAL * table["to_constant"]
        better = table["updated"] < EQUAL * table["classic"]
        shares = {
            "share of regions with the condition in which changes are better": better[meets],
            "share of regions with the condition": meets,
            "share of regions without it in which changes are better": better[~meets],
        }
        numbers = [
            Number(name=name, system="", value=float(its.mean()))
            for name, its in shares.items()
            if len(its)
        ]
        verdict = Verdict.UNDECIDED
        if meets.any():
            often = better[meets].mean() >= OFTEN
            verdict = Verdict.SUPPORTED if often else Verdict.CONTRADICTED
        note = (
            f"Regions are balls. {len(tried) - len(table)} of {len(tried)} contain a pose without"
            " command and are left out. The same centres serve all scales, so shares have no"
            " interval."
        )
        return statement.finding(verdict, *numbers, note=note)

    return judge


def claims(iterations: int) -> list[OfSetups | Measured]:
    """The claims of the section, in its order; `iterations` are those of Figure 1."""
    remaining = partial(Remaining, iterations=iterations)
    both = Contrast(remaining(IMPROVED), remaining("improved_values"))
    criterion = (
        "In at least 95 % of the balls in which the condition holds, the new update is better, over"
        " all scales of the damage and both starts. Better: E_upd below E_clas. The condition: f'"
        " varies less about f than about a constant, whichever constant."
    )
    reason = (
        "The paper's integrals have the winner's own values as constants; the condition does not"
        " depend on them."
    )
    return [
        OfSetups(
            "theta-increments",
            "the information propagated to neighboring units can be modified to improve their"
            " cooperation",
            "Cells should share changes of their commands, not commands.",
            f"After {iterations} iterations the error with increments of theta is below that with"
            " values.",
            "Section 5 changes the system with two maps, so the improved system is judged.",
            name="error with increments of theta / with values",
            system=SYSTEM,
            estimand=Contrast(remaining(IMPROVED), remaining("improved_theta_values")),
            secondary={
                ("error with increments of theta / with values", "Ritter's one map"): Contrast(
                    remaining("ritter_theta_increments"), remaining(RITTER)
                )
            },
        ),
        Measured(
            "theta-reason",
            "this kind of cooperation works better than Ritter et al.'s when the new function is"
            " more similar to the original one than to a constant function",
            "Changes are better if the new mapping is nearer to the old one than to a constant.",
            criterion,
            reason,
            judge_=nearer("theta"),
        ),
        OfSetups(
            "jacobian-increments",
            "in all the relevant aspects for us, the problem is the same we encountered with the"
            " theta_rs update",
            "Cells should share changes of their Jacobians, not Jacobians.",
            f"After {iterations} iterations the error with increments of the Jacobians is below"
            " that with values.",
            "Section 5 changes the system with two maps, so the improved system is judged.",
            name="error with increments of Jacobians / with values",
            system=SYSTEM,
            estimand=Contrast(remaining(IMPROVED), remaining("improved_jacobian_values")),
            secondary={
                ("error with increments of Jacobians / with values", "Ritter's one map"): Contrast(
                    remaining("ritter_jacobian_increments"), remaining(RITTER)
                )
            },
        ),
        Measured(
            "jacobian-reason",
            "The new update version is better than the classical one when the Jacobian function of"
            " f' is more similar to df/dw than to a constant matrix.",
            "The same condition decides for Jacobians.",
            criterion,
            reason,
            judge_=nearer("jacobian"),
        ),
        OfSetups(
            "not-drastic",
            "in the usual case in which the kinematics change is not drastic",
            "Sharing changes helps less after a drastic change of the kinematics.",
            "The error with both increments over that without them is larger with encoder shifts"
            " three times as large.",
            "If the size of the change did not matter, both ratios would be the same.",
            name="error ratio of increments after a drastic change / after the paper's",
            system=SYSTEM,
            estimand=Difference(
                Contrast(remaining("improved_drastic"), remaining("improved_values_drastic")), both
            ),
            comparison=RATIO._replace(below=False),
        ),
        OfSetups(
            "cooperation",
            "the learning is much faster due to the improved cooperation among the learning units",
            "The improved system is better because its cells share changes.",
            f"After {iterations} iterations the error with increments of theta and of Jacobians is"
            " below that with values of both.",
            "Both increments are what improves the cooperation.",
            section="abstract, 8",
            name="error with both increments / with values",
            system=SYSTEM,
            estimand=both,
        ),
    ]
