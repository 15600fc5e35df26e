"""What the page of findings says: what did not replicate, how far it carries, limits."""

from typing import TYPE_CHECKING

import numpy as np

from recalib.study.configuration.switches import IMPROVED, RITTER
from recalib.study.evidence.claims import CLAIMS, speed_up
from recalib.study.evidence.needs import Request
from recalib.study.evidence.results import Evidence
from recalib.study.evidence.words import depends, in_universes, measured, n, verdicts
from recalib.study.measured import ERRORS

if TYPE_CHECKING:
    import pandas as pd

SHORT = ("cm", "deg")
PARTS = (0.1, 0.25, 0.5, 0.75, 0.9)  # of the universes
ELSEWHERE = {"figure1", "figure2", "figure3"}  # shown among all results


def needs(ask: Request) -> None:
    """What the page reads."""
    ask.summary()
    ask.claims()
    ask.coverage()
    ask.outcomes()
    for series in ("assignments", "scaled"):
        ask.ensemble(IMPROVED, series)
    ask.ensemble(RITTER, "assignments")
    ask.sample(ask.fact("improved"))
    ask.fact("iterations")


def _ensemble(ours: "pd.DataFrame", ritters: "pd.DataFrame") -> dict:
    cells = {"robots": len(ours), "ritter_robots": len(ritters)}
    same = ours[ours["robot"].isin(ritters["robot"])]
    for error, unit in zip(ERRORS, SHORT, strict=True):
        final = ours[f"final_{error}"]
        cells |= {f"median_{unit}": final.median(), f"p95_{unit}": final.quantile(0.95)}
        cells |= {
            f"{name}_{unit}": of[f"final_{error}"].median()
            for name, of in (("ritter", ritters), ("same", same))
        }
    return cells


def _scaled(table: "pd.DataFrame") -> list[dict]:
    rows = []
    for scale, own in table.groupby("scale"):
        cells = {"scale": scale}
        for moment in ("initial", "final"):
            for error, unit in zip(ERRORS, SHORT, strict=True):
                cells[f"{moment}_{unit}"] = own[f"{moment}_{error}"].median()
        cells["left"] = max(cells[f"final_{unit}"] / cells[f"initial_{unit}"] for unit in SHORT)
        rows.append(cells)
    return rows


def _refused(summary: "pd.DataFrame") -> str:
    rows = summary[summary["refused"] > 0]
    cases = (
        f"{row.refused:,} of {row.moves * row.seeds:,} for {row.learner} on {row.scenario}"
        for row in rows.itertuples()
    )
    return "; ".join(cases) or "none"


def _multiverse(evidence: Evidence) -> dict:
    """What is said of the universes beside the claims; empty for a study without any."""
    outcomes = evidence.outcomes()
    if outcomes is None:
        return {}
    factors = outcomes["factor"].quantile(PARTS, interpolation="lower")
    design = evidence.whole_design()
    return {
        "count": len(outcomes),
        "refused": design["row"].max() + 1 - len(design),
        "homes": design["homes_refused"].sum(),
        "factors": {f"{100 * p:.0f} %": f"{f:.0f}" for p, f in factors.items() if np.isfinite(f)},
        "beyond": int(np.isinf(outcomes["factor"]).sum()),
        "most": f"{speed_up.CLAIM.limits['factor']:g}",
    }


def _said(claim: dict) -> dict:
    """A judged claim, with what its home says of it besides."""
    home = next(each for each in CLAIMS if each.id == claim["id"])
    figures = [figure.removeprefix("figure") for figure in home.figures]
    return claim | {
        "reason": home.reason.format(**home.limits),
        "figures": " and ".join(f"Figure {figure}" for figure in figures),
    }


def figures() -> list[str]:
    """The figures that show the claims, without those that all results show."""
    named = {figure for claim in CLAIMS for figure in claim.figures} - ELSEWHERE
    return sorted(named, key=lambda name: int(name.removeprefix("figure")))


def context(evidence: Evidence) -> dict:
    """Everything that the page may say."""
    summary, scaled = evidence.summary(), evidence.ensemble(IMPROVED, "scaled")
    coverage = evidence.coverage()
    ensembles = [evidence.ensemble(learner, "assignments") for learner in (IMPROVED, RITTER)]
    ritter = summary.loc[summary["learner"] == RITTER, "iterations"]
    improved = evidence.fact("improved")
    sample, searched_for = evidence.sample(improved), evidence.searched_for(improved)
    return {
        "n": n,
        "measured": measured,
        "verdicts": verdicts,
        "in_universes": in_universes,
        "depends": depends,
        "rule": RULE,
        "universes": _multiverse(evidence),
        "claims": [_said(claim) for claim in evidence.claims()],
        "iterations": evidence.fact("iterations"),
        "ritter_iterations": ritter.max(),
        "figures": figures(),
        "refused": _refused(summary),
        "coverage": 100 * coverage["inside"].mean(),
        "once": coverage.to_dict("records"),
        "trials": len(sample) // searched_for.searches,
        "searches": searched_for.searches,
        "ensemble": _ensemble(*ensembles),
        "scaled": _scaled(scaled),
        "scaled_robots": scaled["robot"].nunique(),
    }
