"""Section 6: how widths should fall."""

from functools import partial

import numpy as np

from replication.config.switches import IMPROVED, RITTER
from replication.judgement.claims.claim import Measured, OfSetups, Statement, log, of_all
from replication.judgement.contrasts import Contrast, Remaining
from replication.judgement.evidence import Evidence
from replication.judgement.findings import Finding, Number, number
from replication.judgement.hierarchy import student
from replication.judgement.verdicts import Comparison, Verdict

FEW, MANY = 20, 10  # iterations, a tenth of Figure 1's; a factor, an order of magnitude
NEAR_A_FACE = 0.3  # up to this width, only one face of the workspace has an effect
DEVIATION = 0.05  # relative deviation from the formula; schedules would not show a smaller one
ERRORS = 3.0  # standard errors of Monte Carlo
AWAY = 3.0  # distance from the border in sigma: 99.7 % of a Gaussian are nearer


def coarse_widths(statement: Statement, evidence: Evidence) -> Finding:
    """Iterations that halve both errors, with wide and with narrow neighbourhoods."""
    table = evidence.mapping("widths")
    taken = np.log(table.pivot(index="seed", columns="width", values="iterations"))
    wide, more = (
        student(its.to_numpy()) for its in (taken["wide"], taken["narrow"] - taken["wide"])
    )
    rates = table.groupby("width")["rate"].first()
    note = (
        f"The learning rates {rates['wide']:g} and {rates['narrow']:g} were best on other poses."
        f" Intervals over {len(taken)} seeds, without the uncertainty of this choice."
    )
    verdict = of_all(
        Comparison(log(MANY), below=False).of_interval(more),
        Comparison(log(FEW)).of_interval(wide),
    )
    return statement.finding(
        verdict,
        number("iterations with narrow / with wide neighbourhoods", "improved system", more),
        number("iterations with wide neighbourhoods", "improved system", wide),
        note=note,
    )


def expected_learning(statement: Statement, evidence: Evidence) -> Finding:
    """Equation (10) against Monte Carlo."""
    table = evidence.mapping("visits")
    away = table[table["distance"] >= AWAY * table["width"]]
    deviation = (away["ratio"] - 1).abs()
    agrees = (deviation <= DEVIATION) & (deviation <= ERRORS * away["error"])
    border = table[(table["distance"] == 0) & (table["width"] <= NEAR_A_FACE)]["ratio"].mean()
    note = (
        f"{len(away)} combinations of width and distance. On a face of the workspace a cell learns"
        f" {100 * border:.0f} % of what the formula predicts."
    )
    return statement.finding(
        Verdict.SUPPORTED if agrees.all() else Verdict.CONTRADICTED,
        Number(name="largest relative deviation", system="", value=float(deviation.max())),
        note=note,
    )


def claims(iterations: int) -> list[OfSetups | Measured]:
    """The claims of the section, in its order; `iterations` are those of Figure 1."""
    remaining = partial(Remaining, iterations=iterations)
    name = "error with equal visits / with exponential widths"
    return [
        Measured(
            "coarse-widths",
            "When the neighborhood width is large [...] Few iterations are then required to learn"
            " the mapping in all the input space at a coarse level of resolution. Instead, when"
            " the neighborhoods are small [...] many more iterations are required",
            "Wide neighbourhoods learn a coarse mapping in few iterations, narrow ones in many.",
            f"With constant widths, both errors are halved after at most {FEW} iterations if"
            f" neighbourhoods are as wide as half of the workspace, and after at least {MANY}"
            " times as many if they are as wide as half of the distance between cells.",
            "Few is a tenth of Figure 1's iterations, many more an order of magnitude. Each width"
            " has the best of four constant rates.",
            judge_=coarse_widths,
        ),
        Measured(
            "expected-learning",
            "The second equality results from assuming Gaussian neighborhoods and a uniform p(w),"
            " and it is valid for w_r's not too close to the border",
            "Equation (10) predicts how much a cell learns in an iteration.",
            "Monte Carlo agrees within 5 % and three of its standard errors for all cells at least"
            " 3 sigma from the border.",
            "No schedule would show a deviation below 5 %.",
            judge_=expected_learning,
        ),
        OfSetups(
            "schedule",
            "The neighborhood scheduling proposed by Ritter et al. does not take into account this"
            " fact. We will derive now a neighborhood scheduling",
            "Widths should fall so that a cell is visited equally often at each of them.",
            f"After {iterations} iterations the error with widths that fall by equal visits is"
            " below that with widths that fall exponentially. The rate falls by the same law.",
            "Section 6 changes the widths alone, in the system with two maps.",
            name=name,
            system="improved system",
            estimand=Contrast(remaining(IMPROVED), remaining("improved_exponential")),
            secondary={
                (name, "Ritter's one map"): Contrast(
                    remaining("ritter_equal_visits"), remaining(RITTER)
                )
            },
        ),
    ]
