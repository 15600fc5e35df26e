"""Section 5: the reason given for increments, E_upd < E_clas."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from recalib.study.evidence.claims.claim import Claim, Finding, Limit
from recalib.study.evidence.needs import Request
from recalib.study.evidence.results import Evidence

if TYPE_CHECKING:
    import pandas as pd

ROUNDING = 1e-6  # from the intact robot, the Jacobian of f is constant: both integrals are equal


def needs(ask: Request) -> None:
    ask.mapping("propagation")
    if 1 not in ask.study.mapping.scales:
        ask.lack("mapping.scales: 1")


def integral_ratios(table: "pd.DataFrame") -> "pd.Series":
    """E_upd / E_clas for each kind, start and scale: the median over the balls.

    Args:
        table: of `recalib.study.mapping.propagation`.

    Scales at which a pose of some ball has no command are left out: the balls that remain would be
    the easy ones.
    """
    balls = table.assign(ratio=table["updated"] / table["classic"]).groupby(
        ["kind", "start", "scale"]
    )["ratio"]
    return balls.median()[balls.count() == balls.size()]


def found(evidence: Evidence, limits: Mapping[str, Limit], kind: str) -> Finding:
    """Whether the new mapping is nearer to the old one than to a constant."""
    ratio = integral_ratios(evidence.mapping("propagation"))[kind]
    intact = ratio["intact"]
    measured = {
        "E_upd / E_clas, intact": intact.get(1, np.nan),
        "E_upd / E_clas, damaged": ratio["damaged"].get(1, np.nan),
    }
    holds = bool(intact.get(1, np.nan) < limits["integrals"] - ROUNDING)
    return Finding(holds, measured, note=_where_it_ends(intact) if holds else EQUAL)


EQUAL = (
    "From the intact robot both integrals are the same: the Jacobian of the identity is constant."
)


def _where_it_ends(intact) -> str:
    scales, above = intact.index, intact.to_numpy() >= 1
    if not above.any():
        return f"E_upd stays below E_clas up to {scales[-1]:g} times the paper's encoder shifts."
    turn = above.argmax()
    return (
        f"E_upd passes E_clas between {scales[turn - 1]:g} and {scales[turn]:g} times the paper's"
        " encoder shifts."
    )


def claim(kind: str, **said) -> Claim:
    """The claim that the reason holds for what is propagated: theta or jacobian."""
    return Claim(
        section="5",
        limits={"integrals": Limit(1.0)},
        reason="It is the paper's own inequality. (Until several searches were made it was judged"
        " together with what the increments do to learning.)",
        needs=needs,
        measure=lambda evidence, limits: found(evidence, limits, kind),
        figures=("figure7",),
        **said,
    )


THETA = claim(
    "theta",
    id="theta-reason",
    statement="The new mapping is nearer to the old one than to a constant.",
    short="The new mapping is nearer to the old one than to a constant: ratio {}",
    published="E_upd < E_clas where f' is more similar to f than to a constant",
    criterion="E_upd / E_clas is below {integrals} for the paper's damage, from the intact robot.",
)
JACOBIAN = claim(
    "jacobian",
    id="jacobian-reason",
    statement="The Jacobian of the new mapping is nearer to the old one's than to a constant.",
    short="The new Jacobian is nearer to the old one than to a constant: ratio {}",
    published="the same for A",
    criterion="As for theta-reason, with the integrals of the Jacobians.",
)
