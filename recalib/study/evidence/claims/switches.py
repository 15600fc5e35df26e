"""Sections 4 to 6: the four changes, each taken from the improved system and added to Ritter's."""

from collections.abc import Mapping

import numpy as np

from recalib.study.configuration.switches import SWITCHES, Switch
from recalib.study.evidence.claims.across import Across
from recalib.study.evidence.claims.claim import Claim, Finding, Limit, below
from recalib.study.evidence.needs import Request
from recalib.study.evidence.results import Evidence
from recalib.study.statistics import Estimate, combined, ratio

BY_KEY = {switch.key: switch for switch in SWITCHES}
RATIO = Limit(1.0)
RATIO_OF = "error with it / without it"
SYSTEMS = "the improved system", "Ritter's"


def compare(evidence: Evidence, ours: str, theirs: str) -> Estimate:
    """The error of one training over that of another."""
    errors = (combined(evidence.errors(each)) for each in (ours, theirs))
    return ratio(*errors, evidence.rng(ours, theirs))


def with_and_without(evidence: Evidence, switch: Switch) -> dict[str, tuple[str, str]]:
    """The trainings with a change and without it, by what the comparison is called."""
    return {
        "improved with it / without it": (evidence.fact("improved"), switch.without),
        "Ritter with it / without it": (switch.added, evidence.fact("short")),
    }


def ask_for(ask: Request, switches: tuple[Switch, ...]) -> None:
    """Ask for what `with_and_without` compares."""
    for role in ("improved", "short"):
        ask.history(ask.fact(role))
    for switch in switches:
        for learner in (switch.without, switch.added):
            ask.history(learner, key="experiments.switches: true")
    ask.fact("seed")


def found(evidence: Evidence, limits: Mapping[str, Limit], switch: Switch) -> Finding:
    """Where a change helps."""
    pairs = with_and_without(evidence, switch)
    estimates = {label: compare(evidence, *pair) for label, pair in pairs.items()}
    judged = (below(each, limits["ratio"]) for each in estimates.values())
    by_kind = []
    for label, pair in pairs.items():
        logarithms = (np.log(evidence.errors(each)).mean(axis=(0, 1)) for each in pair)
        kinds = np.exp(np.subtract(*logarithms))
        by_kind.append(f"{label}, {kinds[0]:.2f} in position and {kinds[1]:.2f} in orientation")
    note = f"By kind of error: {'; '.join(by_kind)}."
    return Finding.of(dict(zip(SYSTEMS, judged, strict=True)), estimates, note)


def claim(switch: Switch, facts: tuple[str, ...] = (), **said) -> Claim:
    """The claim that a change helps; `facts` are those that its texts name."""

    def needs(ask: Request) -> None:
        ask_for(ask, (switch,))
        for fact in facts:
            ask.fact(fact)

    return Claim(
        limits={"ratio": RATIO},
        needs=needs,
        measure=lambda evidence, limits: found(evidence, limits, switch),
        across={
            SYSTEMS[0]: Across(f"{switch.key}_improved", RATIO_OF),
            SYSTEMS[1]: Across(f"{switch.key}_ritter", RATIO_OF),
        },
        **said,
    )


SEPARATE_MAPS = claim(
    BY_KEY["maps"],
    id="separate-maps",
    section="4",
    statement="Two maps, one for position and one for orientation commands, learn significantly"
    " faster than one.",
    short="Two maps beat one: {} times the error",
    published="a significant increase in learning speed",
    criterion="The error with the change over that without it is below {ratio} (whole interval) for"
    " the improved system or for Ritter's, and above it for neither; not supported the other way"
    " round. The error is the geometric mean of both after {iterations} iterations.",
    facts=("iterations",),
    reason="Significant is an interval without 1. (Until several searches were made, a change had"
    " to help both systems; now the note says which.)",
    figures=("figure4", "figure5"),
)
THETA_INCREMENTS = claim(
    BY_KEY["theta"],
    id="theta-increments",
    section="5",
    statement="Propagating increments of theta beats propagating values.",
    short="Increments of theta beat values: {} times the error",
    published="no number",
    criterion="As for separate-maps, with this switch.",
    reason="As for separate-maps.",
    figures=("figure4",),
)
JACOBIAN_INCREMENTS = claim(
    BY_KEY["jacobian"],
    id="jacobian-increments",
    section="5",
    statement="Propagating increments of the Jacobians beats propagating values.",
    short="Increments of the Jacobians beat values: {} times the error",
    published="no number",
    criterion="As for separate-maps, with this switch.",
    reason="As for separate-maps.",
    figures=("figure4",),
)
SCHEDULE = claim(
    BY_KEY["schedule"],
    id="schedule",
    section="6",
    statement="A schedule with equal visits at every width beats Ritter's.",
    short="Equal visits at every width beat Ritter's schedule: {} times the error",
    published="no number",
    criterion="As for separate-maps, with this switch.",
    reason="As for separate-maps.",
    figures=("figure4", "figure8"),
)
