"""Sections 5 and 6: three changes, each taken from the improved system and added to Ritter's."""

from collections.abc import Mapping

import numpy as np

from recalib.study.configuration.switches import SWITCHES, Switch
from recalib.study.evidence.claims.across import Across
from recalib.study.evidence.claims.claim import Claim, Finding
from recalib.study.evidence.results import Evidence
from recalib.study.inference.intervals import Estimate, combined, ratio

BY_KEY = {switch.key: switch for switch in SWITCHES}
SYSTEMS = "improved system", "Ritter's"
RATIO_OF = "error with it / without it"


def compare(evidence: Evidence, ours: str, theirs: str) -> Estimate:
    """The error of one training over that of another."""
    own, others = (combined(evidence.errors(name)) for name in (ours, theirs))
    return ratio(own, others, evidence.rng(ours, theirs))


def with_and_without(evidence: Evidence, switch: Switch) -> dict[str, tuple[str, str]]:
    """The trainings with a change and without it, by system."""
    pairs = (evidence.facts["improved"], switch.without), (switch.added, evidence.facts["short"])
    return dict(zip(SYSTEMS, pairs, strict=True))


def claim(key: str, **said) -> Claim:
    """The claim that a change helps."""
    switch = BY_KEY[key]

    def measure(evidence: Evidence, _: Mapping) -> Finding:
        pairs, by_kind = with_and_without(evidence, switch), []
        for system, pair in pairs.items():
            logarithms = (np.log(evidence.errors(name)).mean(axis=(0, 1)) for name in pair)
            kinds = np.exp(np.subtract(*logarithms))
            by_kind.append(f"{system}, {kinds[0]:.2f} in position, {kinds[1]:.2f} in orientation")
        estimates = {system: compare(evidence, *pair) for system, pair in pairs.items()}
        return Finding(estimates, note=f"By kind of error: {'; '.join(by_kind)}.")

    return Claim(
        criterion="The error with the change over that without it is below 1. The error is the"
        " geometric mean of position and orientation error after {iterations} iterations.",
        needs="runs/{scenario}/{improved}.parquet runs/{scenario}/{short}.parquet seed iterations"
        f" runs/{{scenario}}/{switch.without}.parquet runs/{{scenario}}/{switch.added}.parquet",
        measure=measure,
        across={
            system: Across(f"{key}_{column}", RATIO_OF)
            for system, column in zip(SYSTEMS, ("improved", "ritter"), strict=True)
        },
        **said,
    )


ON_TWO_MAPS = "Sections 5 and 6 change the system with two maps, so the improved system is judged."

THETA = claim(
    "theta",
    id="theta-increments",
    section="5",
    quotation="the information propagated to neighboring units can be modified to improve their"
    " cooperation",
    statement="Cells should share changes of their commands, not commands.",
    short="error x {number}",
    reason=ON_TWO_MAPS,
    figures=("figure4",),
)
JACOBIAN = claim(
    "jacobian",
    id="jacobian-increments",
    section="5",
    quotation="in all the relevant aspects for us, the problem is the same",
    statement="They should share changes of their Jacobians, not Jacobians.",
    short="error x {number}",
    reason=ON_TWO_MAPS,
    figures=("figure4",),
)
SCHEDULE = claim(
    "schedule",
    id="schedule",
    section="6",
    quotation="The neighborhood scheduling proposed by Ritter et al. does not take into account"
    " this fact.",
    statement="Widths should fall so that a cell is visited equally often at each of them.",
    short="error x {number}",
    reason=ON_TWO_MAPS + " In the reference study and in half of the setups the rate falls linearly"
    " with equal visits and exponentially without, so both change at once. Setups vary n, too; the"
    " section on the schedule takes all three apart.",
    figures=("figure4", "figure8"),
)
