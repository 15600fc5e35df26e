"""Section 3: the intact robot."""

from recalib.study.evidence.claims.across import Across
from recalib.study.evidence.claims.claim import Claim, Finding, Limit
from recalib.study.measured import ERRORS

SCENARIO = "intact"


def needs(ask):
    for role in ("improved", "short"):
        ask.history(ask.fact(role), SCENARIO)
    ask.fact("iterations")


def measure(evidence, limits):
    worst = evidence.history(evidence.fact("improved"), SCENARIO)[list(ERRORS)].max()
    ritter = evidence.errors(evidence.fact("short"), SCENARIO).mean(axis=(0, 1))
    note = (
        f"Ritter's values do not leave it there: {ritter[0]:.2g} cm and {ritter[1]:.2g} degrees"
        f" after {evidence.fact('iterations')} iterations."
    )
    measured = {"largest cm": worst.iloc[0], "largest degrees": worst.iloc[1]}
    return Finding(bool((worst < limits["error"]).all()), measured, note=note)


CLAIM = Claim(
    id="identity",
    section="3",
    statement="For the intact robot the mapping is the identity, and learning leaves it there.",
    short="The intact robot's mapping is the identity, and stays so: {} cm off",
    published="no number",
    limits={"error": Limit(0.001)},
    criterion="The improved system's errors on the intact robot stay below {error} cm and {error}"
    " degrees in every measurement.",
    reason="Rounding and the controller's tolerance leave far less, and no instrument on a robot"
    " sees as much.",
    needs=needs,
    measure=measure,
    across={"": Across("intact", "largest error [cm, degrees]", "error")},
    figures=("figure3",),
)
