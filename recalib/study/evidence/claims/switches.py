"""Sections 4 to 6: the four changes, each taken from the improved system and added to Ritter's."""

from collections.abc import Mapping

import numpy as np

from recalib.study.configuration.switches import SWITCHES, Switch
from recalib.study.evidence.claims.claim import Claim, Finding, Limit
from recalib.study.evidence.needs import Request
from recalib.study.evidence.results import Evidence
from recalib.study.statistics import Estimate, paired_ratio

BY_KEY = {switch.key: switch for switch in SWITCHES}
RATIO = Limit(1.0)


def combined(errors: np.ndarray) -> np.ndarray:
    """Geometric mean (seed,) of both errors (seed, 2)."""
    return np.sqrt(errors.prod(axis=1))


def compare(evidence: Evidence, ours: str, theirs: str) -> Estimate:
    """The error of one training over that of another, paired by seed."""
    errors = (combined(evidence.errors(each)) for each in (ours, theirs))
    return paired_ratio(*errors, evidence.rng(ours, theirs))


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
    """Whether a change helps wherever it is made."""
    pairs = with_and_without(evidence, switch)
    estimates = {label: compare(evidence, *pair) for label, pair in pairs.items()}
    by_kind = []
    for label, pair in pairs.items():
        logarithms = (np.log(evidence.errors(each)).mean(axis=0) for each in pair)
        ratio = np.exp(np.subtract(*logarithms))
        by_kind.append(f"{label}: {ratio[0]:.2f} in position and {ratio[1]:.2f} in orientation")
    holds = all(each.high < limits["ratio"] for each in estimates.values())
    return Finding.of(holds, estimates, "; ".join(by_kind) + ".")


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
        **said,
    )


def claim_with_reason(switch: Switch, kind: str, **said) -> Claim:
    """The claim that a change helps, for the reason given in section 5: the integrals."""

    def needs(ask: Request) -> None:
        ask_for(ask, (switch,))
        ask.mapping("propagation")
        if 1 not in ask.study.mapping.scales:
            ask.lack("mapping.scales: 1")

    def measure(evidence: Evidence, limits: Mapping[str, Limit]) -> Finding:
        return _with_integrals(found(evidence, limits, switch), evidence, limits, kind)

    return Claim(
        limits={"ratio": RATIO, "integrals": Limit(1.0)},
        reason="The claim and the reason given for it are both measured.",
        needs=needs,
        measure=measure,
        figures=("figure4", "figure7"),
        **said,
    )


def _with_integrals(
    finding: Finding, evidence: Evidence, limits: Mapping[str, Limit], kind: str
) -> Finding:
    from recalib.study.mapping.propagation import integral_ratios

    ratio = integral_ratios(evidence.mapping("propagation"))[kind]
    intact = ratio["intact"]
    finding.measured |= {
        "E_upd / E_clas, intact": intact.get(1, np.nan),
        "E_upd / E_clas, damaged": ratio["damaged"].get(1, np.nan),
    }
    # From the intact robot, the Jacobian of f is constant: the integrals differ by rounding only.
    nearer = bool(intact.get(1, np.nan) < limits["integrals"] - 1e-6)
    finding.holds &= nearer
    scales, above = intact.index, intact.to_numpy() >= 1
    if not nearer:
        finding.note += (
            " From the intact robot both integrals are the same: the Jacobian of the identity is"
            " constant."
        )
    elif above.any():
        turn = above.argmax()
        finding.note += (
            f" E_upd passes E_clas between {scales[turn - 1]:g} and {scales[turn]:g} times the"
            " paper's encoder shifts."
        )
    else:
        finding.note += (
            f" E_upd stays below E_clas up to {scales[-1]:g} times the paper's encoder shifts."
        )
    return finding


SEPARATE_MAPS = claim(
    BY_KEY["maps"],
    id="separate-maps",
    section="4",
    statement="Two maps, one for position and one for orientation commands, learn significantly"
    " faster than one.",
    published="a significant increase in learning speed",
    criterion="The error of the improved system over that with a single map is below {ratio}, and"
    " so is Ritter's with separate maps over Ritter's (upper ends, geometric mean of both errors"
    " after {iterations} iterations, paired seeds).",
    facts=("iterations",),
    reason="Significant is an interval without 1, and a change that helps should help wherever it"
    " is made.",
    figures=("figure4", "figure5"),
    interpretation="Added to Ritter's algorithm, two maps help as published. One map whose"
    " increments are propagated learns about as well as two, though: the coupling is so weak, and"
    " the widths that the search finds so large, that the contradiction which section 4 describes"
    " hardly arises. That one map even comes out ahead may be luck of the search, which has fewer"
    " widths to find.",
)
THETA_INCREMENTS = claim_with_reason(
    BY_KEY["theta"],
    "theta",
    id="theta-increments",
    section="5",
    statement="Propagating increments of theta beats propagating values, because the new mapping is"
    " nearer to the old one than to a constant.",
    published="E_upd < E_clas where f' is more similar to f than to a constant",
    criterion="As for separate-maps with this switch; and E_upd / E_clas is below {integrals} for"
    " the paper's damage, from the intact robot.",
)
JACOBIAN_INCREMENTS = claim_with_reason(
    BY_KEY["jacobian"],
    "jacobian",
    id="jacobian-increments",
    section="5",
    statement="Propagating increments of the Jacobians beats propagating values, for the same"
    " reason.",
    published="the same for A",
    criterion="As for theta-increments, with this switch and the integrals of the Jacobians.",
    interpretation="Starting from an intact robot the old mapping has a constant Jacobian, so that"
    " the reason given in section 5 cannot favour either rule: both integrals are equal. It does"
    " favour increments for a robot that was damaged before. The two rules differ by the winner's"
    " Jacobian less that of the cell that learns; all start as the identity, and within so few"
    " iterations of Ritter's algorithm they hardly part.",
)
SCHEDULE = claim(
    BY_KEY["schedule"],
    id="schedule",
    section="6",
    statement="A schedule with equal visits at every width beats Ritter's.",
    published="no number",
    criterion="As for separate-maps, with this switch.",
    reason="As for separate-maps.",
    figures=("figure4", "figure8"),
    interpretation="The law of section 6 rests on (10), which holds far from the border only"
    " (Figure 8); the widths that the search finds are larger than the workspace at first, so that"
    " visits are not equal in fact. The switch also changes the decay of the rate, from exponential"
    " to linear, as the paper's did. How the widths shrink matters little within so few"
    " iterations.",
)
