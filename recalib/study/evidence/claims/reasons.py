"""Section 5: the condition under which increments are better than values."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

from recalib.study.evidence.claims.claim import Claim, Finding, Limit
from recalib.study.evidence.results import Evidence
from recalib.study.evidence.verdicts import Verdict

if TYPE_CHECKING:
    import pandas as pd

EQUAL = 1 - 1e-6  # nearer to 1, two means differ by rounding


def integral_ratios(table: "pd.DataFrame") -> "pd.Series":
    """E_upd / E_clas for each kind, start and scale of propagation: the median over the balls.

    Scales at which a pose of some ball has no command are left out: the balls that remain would be
    the easy ones.
    """
    balls = table.assign(ratio=table["updated"] / table["classic"]).groupby(
        ["kind", "start", "scale"]
    )["ratio"]
    return balls.median()[balls.count() == balls.size()]


def found(evidence: Evidence, limits: Mapping[str, Limit], kind: str) -> Finding:
    """In how many balls that meet the condition the new update is better."""
    tried = evidence.table("mapping/propagation.parquet").query("kind == @kind")
    table = tried.dropna()
    meets = table["to_original"] < EQUAL * table["to_constant"]
    better = table["updated"] < EQUAL * table["classic"]
    numbers, verdict = {}, Verdict.UNDECIDED
    if meets.any():
        share = float(better[meets].mean())
        verdict = Verdict.SUPPORTED if share >= limits["share"] else Verdict.CONTRADICTED
        about = "share of balls in which the new update is better, where the condition holds"
        numbers[about] = share
    numbers["share of balls in which the condition holds"] = float(meets.mean())
    if (~meets).any():
        numbers["share in which it is better where it does not"] = float(better[~meets].mean())
    neutral = table.query("start == 'intact'")
    equal = (neutral["to_original"] >= EQUAL * neutral["to_constant"]).all()
    balls = tried.groupby(["start", "scale"]).size().max()
    note = (
        f"The same {balls} centres serve all {tried['scale'].nunique()} scales and both starts, so"
        f" the shares have no interval. {len(tried) - len(table)} of {len(tried)} balls are left"
        " out, since some pose in them has no command."
    )
    if kind == "jacobian" and equal:
        note += (
            " From the intact robot the Jacobian of the mapping is constant, so both updates are"
            " equal there."
        )
    return Finding(verdict=verdict, numbers=numbers, note=note)


def claim(kind: str, **said) -> Claim:
    """The claim that the condition decides for what is propagated: theta or jacobian."""
    return Claim(
        section="5",
        limits={"share": Limit(0.95)},
        criterion="The new update is better in at least {share:percent} of the balls in which the"
        " condition holds, over all scales of the damage and both starts. Better: E_upd below"
        " E_clas. The condition: f' varies less about f than about a constant, whichever constant.",
        reason="The paper's integrals have the winner's own values as constants; the condition does"
        " not depend on them.",
        needs="mapping/propagation.parquet",
        measure=lambda evidence, limits: found(evidence, limits, kind),
        figures=("figure7",),
        **said,
    )


THETA = claim(
    "theta",
    id="theta-reason",
    quotation="this kind of cooperation works better than Ritter et al.'s when the new function"
    " is more similar to the original one than to a constant function",
    statement="Changes are better if the new mapping is nearer to the old one than to a constant.",
    short="true in {percent} of the regions where it is nearer",
)
JACOBIAN = claim(
    "jacobian",
    id="jacobian-reason",
    quotation="The new update version is better than the classical one when the Jacobian function"
    " of f' is more similar to df/dw than to a constant matrix.",
    statement="The same holds for Jacobians.",
    short="true in {percent} of the regions where it is nearer",
)
