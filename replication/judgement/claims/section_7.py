"""Sections 1 and 7: the experiments."""

from collections.abc import Callable
from itertools import product

import numpy as np

from replication.campaign.variants import DOUBLE
from replication.config.switches import IMPROVED
from replication.judgement.claims.claim import (
    Measured,
    OfSetups,
    Statement,
    TooFewSetups,
    enough,
    log,
    of_all,
)
from replication.judgement.contrasts import Crossing, Remaining
from replication.judgement.evidence import Evidence
from replication.judgement.findings import Finding, number, spread
from replication.judgement.hierarchy import another, student
from replication.judgement.verdicts import Comparison, Verdict, of_published
from replication.scenarios.assignments import TIE
from replication.training.measured import ERRORS, KINDS, NONE, RIGID

PUBLISHED = 70
LONG = 50  # factor: 10,000 iterations divided by 200
SMALL = 0.1  # remaining share: a figure shows a reduction by an order of magnitude
NEAR = 0.05  # relative deviation from both published errors


def rigid(statement: Statement, evidence: Evidence) -> Finding:
    """What remains in simulation of the errors of a robot that was moved as a whole."""
    found, iterations = {}, evidence.study.experiments.iterations
    for scenario, (kind, name) in product(RIGID, enumerate(KINDS)):
        first, last = (
            evidence.errors(IMPROVED, iterations, scenario, first=when)[:, kind]
            for when in (True, False)
        )
        if first.max() >= NONE:
            found[f"{name} error, {scenario.replace('_', ' and ')}"] = student(np.log(last / first))
    numbers = [
        number(f"remaining share of the {name}", "improved system", its)
        for name, its in found.items()
    ]
    numbers.sort(key=lambda its: -its.value)
    note = "Intervals over seeds. The results of the real robot are not published in numbers."
    return statement.finding(Verdict.UNDECIDED, *numbers, note=note)


def initial_error(statement: Statement, evidence: Evidence) -> Finding:
    """Where the published initial errors lie among those of other robots and assignments."""
    table = evidence.table("workflow/campaign/untrained.csv")
    published = evidence.study.paper_damage.published.model_dump()
    numbers, verdicts = [], []
    for error in ERRORS:
        logs = np.log(table[error].to_numpy())
        numbers.append(number(f"mean initial {error}", "", student(logs), another(logs)))
        verdicts.append(of_published(log(published[error]), another(logs)))
    ours = evidence.table(f"assignments/{evidence.study.robot}.parquet")
    nearest = ours.loc[ours["distance"].round(TIE).idxmin()]
    below = [(ours[error] < published[error]).mean() for error in ERRORS]
    note = (
        f"Lengths are scaled to the {evidence.study.robot.upper()}."
        f" {int((ours['distance'] <= NEAR).sum())} of its {len(ours):,} assignments come within"
        f" {100 * NEAR:g} % of both published errors; the nearest has {nearest[ERRORS[0]]:.2f} cm"
        f" and {nearest[ERRORS[1]]:.2f} degrees. {100 * below[0]:.0f} % have a smaller position"
        f" error, {100 * below[1]:.0f} % a smaller orientation error."
    )
    return statement.finding(of_all(*verdicts), *numbers, note=note)


def speed_up(iterations: int) -> Callable[[Statement, Evidence], Finding]:
    """How to judge the factor of 70: by where one more study would find its own."""
    goal = Remaining(IMPROVED, iterations)
    ways = {
        ("iterations of Ritter's map / of the improved system", "equally many cells"): Crossing(
            DOUBLE, goal
        ),
        ("with a rough search for the improved system", "as in the paper"): Crossing(
            DOUBLE, Remaining("improved_rough", iterations)
        ),
    }

    def judge(statement: Statement, evidence: Evidence) -> Finding:
        numbers, models = [], []
        for (name, system), crossing in ways.items():
            values = crossing.values(evidence.outcomes())
            if not enough(values):
                raise TooFewSetups(name)
            its = values.model()
            models.append((its, values))
            numbers.append(number(name, system, its.mean, its.another))
        its, values = models[0]
        verdict = of_published(log(PUBLISHED), its.another)
        ends = (values.bounds != 0).to_numpy().sum()
        note = f"{ends} of {int(values.table.count().sum())} factors are bounds."
        long = Comparison(log(LONG), below=False)
        return statement.finding(
            verdict,
            *numbers,
            note=note,
            spread=spread(its, values.unsettled, long.shares(its), None),
        )

    return judge


def claims(iterations: int) -> list[OfSetups | Measured]:
    """The claims of the section, in its order; `iterations` are those of Figure 1."""
    name = "larger remaining share of the two errors"
    return [
        Measured(
            "rigid",
            "The results were in complete agreement with the simulation results for the same"
            " situation",
            "A real robot, moved and turned as a whole, agreed with the simulation.",
            "A real robot, moved and turned as a whole, learns as the simulation does.",
            "The technical report has the numbers.",
            judge_=rigid,
        ),
        Measured(
            "initial-error",
            "the initial mean average position and orientation error, when executing (1), was 8.3"
            " cm and 4.7 degrees, respectively",
            "This damage gives initial errors of 8.3 cm and 4.7 degrees.",
            "Both published errors lie in the intervals in which one more robot, with an"
            " assignment drawn anew, would have its own, and their ends differ by a factor of 4 at"
            " most.",
            "Robot, links, encoders and signs are not published, so only plausibility can be"
            " tested. A wider interval agrees with anything.",
            published="8.3 cm, 4.7 degrees",
            judge_=initial_error,
        ),
        OfSetups(
            "figure-1",
            "Figure 1 shows the results of performing 200 iterations with our learning system",
            "200 iterations make both errors small.",
            f"After {iterations} iterations less than a tenth of both errors of the arm remains.",
            "An order of magnitude is the least that a figure would show.",
            name=name,
            system="improved system",
            estimand=Remaining(IMPROVED, iterations),
            comparison=Comparison(log(SMALL)),
        ),
        Measured(
            "speed-up",
            "speeding up learning by a factor of 70 (near to 2 orders of magnitude)",
            "Ritter's map needs about 70 times as many iterations for the same errors.",
            f"{PUBLISHED} lies in the interval in which one more study on one more robot would"
            " find its factor, and the ends of this interval differ by a factor of 4 at most.",
            "A published number is one study on one robot. Ritter's map has as many cells as both"
            " new maps, as in the paper; both are tuned for each number of iterations.",
            section="1, 7",
            published=f"a factor of {PUBLISHED}",
            judge_=speed_up(iterations),
        ),
        OfSetups(
            "long",
            "The original Ritter et al.'s algorithm with optimized parameters required more than"
            " 10,000 iterations to get the same combination of orientation and position errors",
            "Ritter's map needs more than 10,000 iterations for these errors.",
            f"The factor is above {LONG}: more than 10,000 iterations over {iterations}.",
            "Both errors have to be reached. Ritter's map has as many cells as both new maps.",
            published="more than 10,000 iterations",
            name="iterations of Ritter's map / of the improved system",
            system="equally many cells",
            estimand=Crossing(DOUBLE, Remaining(IMPROVED, iterations)),
            comparison=Comparison(log(LONG), below=False),
        ),
        OfSetups(
            "rough-search",
            "The parameters were selected after a very rough search",
            "A very rough search finds the parameters.",
            "With the best of 16 settings, less than a tenth of both errors remains after"
            f" {iterations} iterations.",
            "Figure 1, whose parameters were found so, has the same criterion.",
            name=name,
            system="improved system, 16 settings tried",
            estimand=Remaining("improved_rough", iterations),
            comparison=Comparison(log(SMALL)),
        ),
    ]
