"""Section 7: the whole robot moved."""

from recalib.study.evidence.claims.across import Across
from recalib.study.evidence.claims.claim import Claim, Finding, Limit, below, every
from recalib.study.evidence.claims.shares import left
from recalib.study.measured import ERRORS, KINDS

SCENARIOS = "translation", "rotation", "translation_rotation"
NONE = 1e-6  # cm and degrees: an initial error below it is rounding


def needs(ask):
    for scenario in SCENARIOS:
        ask.history(ask.fact("improved"), scenario)
    for fact in ("iterations", "seed"):
        ask.fact(fact)


def measure(evidence, limits):
    judged, estimates, zero, improved = [], {}, {}, evidence.fact("improved")
    for scenario in SCENARIOS:
        for kind, name in enumerate(KINDS):
            label = f"{scenario.replace('_', ' and ')}, {name}"
            if evidence.errors(improved, scenario, "first")[..., kind].max() < NONE:
                label += " at most"
                zero[label] = evidence.history(improved, scenario)[ERRORS[kind]].max()
                judged.append(bool(zero[label] < limits["zero"]))
            else:
                estimates[label] = left(evidence, improved, kind, scenario)
                judged.append(below(estimates[label], limits["left"]))
    return Finding.of(every(judged), estimates, **zero)


CLAIM = Claim(
    id="rigid",
    section="7",
    statement="Translations and rotations of the whole robot are learned.",
    short="Translations and rotations of the whole robot are learned: {} left",
    published="complete agreement of the real robot with the simulation",
    limits={"left": Limit(0.05), "zero": Limit(0.01)},
    criterion="The improved system leaves at most {left:percent} of either initial error after"
    " {iterations} iterations (whole intervals); an error that is zero to begin with stays below"
    " {zero} cm and {zero} degrees.",
    reason="The paper gives no figure; a twentieth of a few centimetres is near to what a robot of"
    " 1996 repeats.",
    needs=needs,
    measure=measure,
    across={"": Across("rigid_left", "larger share left", "left")},
    figures=("figure3",),
)
