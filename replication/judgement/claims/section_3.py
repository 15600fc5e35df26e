"""Section 3: commands in place of joint angles, cells on a grid, Ritter's algorithm as it is."""

import numpy as np

from replication.campaign.variants import DOUBLE
from replication.config.switches import IMPROVED, RITTER
from replication.judgement.claims.claim import Measured, OfSetups, Statement, log, of_all
from replication.judgement.contrasts import Contrast, Remaining
from replication.judgement.evidence import Evidence
from replication.judgement.findings import Finding, Number, number
from replication.judgement.hierarchy import Estimate, student
from replication.judgement.verdicts import RATIO, Comparison, Verdict
from replication.training.measured import ERRORS

LARGEST = 0.001  # cm and degrees: rounding and the controller's tolerance cause far less
SLOW = 0.25  # remaining share of the error, from which on a learner is not quick
WORSE = 1.1  # factor: up to this multiple of the least known error, an error counts as least


def identity(statement: Statement, evidence: Evidence) -> Finding:
    """The intact robot: the improved system's errors in every measurement."""
    history = evidence.history(IMPROVED, evidence.study.experiments.iterations, "intact")
    largest = [
        Number(
            name=f"largest {column}", system=IMPROVED, value=float(f"{history[column].max():.2g}")
        )
        for column in ERRORS
    ]
    holds = all(history[column].max() < LARGEST for column in ERRORS)
    ritter = evidence.errors(RITTER, evidence.study.experiments.iterations, "intact").mean(axis=0)
    note = (
        f"Ritter's map, whose cells share commands, moves away from the identity: its errors are"
        f" {ritter[0]:.2g} cm and {ritter[1]:.2g} degrees after as many iterations."
    )
    verdict = Verdict.SUPPORTED if holds else Verdict.CONTRADICTED
    return statement.finding(verdict, *largest, note=note)


def single_valued(statement: Statement, evidence: Evidence) -> Finding:
    """How many commands lead to a pose that many joint angles reach."""
    table = evidence.mapping("solutions")
    commands, angles = table["commands"], table["joint_solutions"]
    numbers = [
        Number(name=f"{which} number of commands that reach a pose", system="", value=float(value))
        for which, value in (("largest", commands.max()), ("smallest", commands.min()))
    ]
    note = (
        f"On average {angles.mean():.1f} sets of joint angles reach a pose, at most"
        f" {angles.max()}, over {len(table):,} poses."
    )
    verdict = Verdict.SUPPORTED if (commands == 1).all() else Verdict.CONTRADICTED
    return statement.finding(verdict, *numbers, note=note)


def grid(statement: Statement, evidence: Evidence) -> Finding:
    """The quantisation error of the regular grid over that of other placements of its cells."""
    table = evidence.mapping("quantisation")
    distances = np.log(table.pivot(index="seed", columns="placement", values="distance"))

    def over(placement: str) -> Estimate:
        return student((distances["boxes"] - distances[placement]).to_numpy())

    kohonen, least = over("kohonen_10000"), over("kmeans")
    numbers = [
        number(f"quantisation error of the regular grid / of {name}", "", estimate)
        for name, estimate in (
            ("cells placed by Kohonen's rule", kohonen),
            ("cells placed by k-means", least),
            ("a grid that reaches the faces", over("faces")),
        )
    ]
    verdict = of_all(RATIO.of_interval(kohonen), Comparison(log(WORSE)).of_interval(least))
    return statement.finding(verdict, *numbers)


def claims(iterations: int) -> list[OfSetups | Measured]:
    """The claims of the section, in its order; `iterations` are those of Figure 1."""
    return [
        Measured(
            "identity",
            "For the intact robot, this mapping is the identity.",
            "The intact robot needs no correction, and learns none.",
            f"The improved system's errors on the intact robot stay below {LARGEST} cm and"
            f" {LARGEST} degrees in every measurement.",
            "Rounding and the controller's tolerance cause far smaller errors.",
            judge_=identity,
        ),
        Measured(
            "single-valued",
            "avoids the problem of the original application of having a multivalued inverse"
            " function, because the controller always chooses the same joint angles for a fixed"
            " command",
            "Many joint angles reach a pose, but only one command does.",
            "Of all joint angles found with which the damaged arm reaches a pose, the controller"
            " chooses exactly one for the command that asks for it, at every pose of every"
            " scenario.",
            "For each pose, Newton's method from 50 random starts finds the joint angles.",
            judge_=single_valued,
        ),
        Measured(
            "grid",
            "we can directly place the centers of the cells in a regular grid covering it, in"
            " order to minimize the quantization error. These centers do not need to move",
            "A regular grid of cells covers the workspace best.",
            "The quantisation error of the regular grid is below that of cells placed by Kohonen's"
            f" rule, and at most {WORSE} times the least that k-means finds.",
            "Within a tenth of the least known counts as least. Kohonen's rule is the step that"
            " the paper leaves out.",
            judge_=grid,
        ),
        OfSetups(
            "ritter-slow",
            "was not as quick as expected, even if the neighborhood widths were tuned in order to"
            " maximize learning speed",
            "Ritter's map is slow, even with its widths tuned.",
            f"After {iterations} iterations, tuned for them, more than a quarter of an error of"
            " the arm remains.",
            "A learner that leaves a quarter of the error is not quick.",
            name="larger remaining share of the two errors",
            system="Ritter's one map",
            estimand=Remaining(DOUBLE, iterations),
            comparison=Comparison(log(SLOW), below=False),
            secondary={
                ("error from a random start / from the identity", "Ritter's one map"): Contrast(
                    Remaining("ritter_random_start", iterations), Remaining(RITTER, iterations)
                )
            },
        ),
    ]
