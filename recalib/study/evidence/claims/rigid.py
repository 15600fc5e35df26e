"""Section 7: the whole robot moved."""

from recalib.study.evidence.claims.claim import Claim, Finding
from recalib.study.evidence.claims.remaining import remaining
from recalib.study.evidence.verdicts import Verdict
from recalib.study.inference.measured import ERRORS, KINDS, NONE, RIGID


def measure(evidence, limits):
    estimates, largest, improved = {}, {}, evidence.facts["improved"]
    for scenario in RIGID:
        for kind, name in enumerate(KINDS):
            label = f"{scenario.replace('_', ' and ')}, {name} error"
            if evidence.errors(improved, scenario, "first")[..., kind].max() < NONE:
                worst = evidence.history(improved, scenario)[ERRORS[kind]].max()
                largest[f"{label} at most"] = max(worst, NONE)
            else:
                estimates[label] = remaining(evidence, improved, kind, scenario)
    most_first = sorted(estimates.items(), key=lambda its: its[1].mean, reverse=True)
    return Finding(
        dict(most_first),
        Verdict.UNDECIDED,
        largest,
        "The numbers say how much of the initial errors remains in simulation. What the real robot"
        " did is not published in numbers, and no run here can repeat it.",
    )


CLAIM = Claim(
    id="rigid",
    section="7",
    quotation="The results were in complete agreement with the simulation results for the same"
    " situation",
    statement="A real robot, moved and turned as a whole, agreed with the simulation.",
    short="no real robot here; at most {percent} remains in simulation",
    criterion="A real robot, moved and turned as a whole, learns as the simulation does.",
    reason="The technical report has the numbers.",
    needs=" ".join(["seed", *(f"runs/{scenario}/{{improved}}.parquet" for scenario in RIGID)]),
    measure=measure,
    figures=("figure3",),
)
