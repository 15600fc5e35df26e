"""What the page of findings says: what did not replicate, how far it carries, limits."""

import math
import statistics
from functools import partial
from typing import TYPE_CHECKING

from replication.config import shipped
from replication.config.switches import IMPROVED, RITTER
from replication.judgement.claims import CLAIMS
from replication.judgement.claims.claim import Claim
from replication.judgement.factor import PUBLISHED, factor_table
from replication.judgement.factor_in_setups import in_setups
from replication.judgement.hierarchy import ASSUMED_LUCK
from replication.judgement.reference import (
    schedules,
    speed_of_two_maps,
    two_maps,
    width_order,
)
from replication.judgement.results import Evidence, Words
from replication.judgement.verdicts import RATIO, Verdict
from replication.pages.parts import otherwise, parts
from replication.pages.words import depends, level_in_words
from replication.training.measured import ERRORS

if TYPE_CHECKING:
    import pandas as pd

SHORT = ("cm", "deg")
ENOUGH = 0.8  # of the simulated campaigns
ORDER = Verdict.CONTRADICTED, Verdict.NO_EFFECT, Verdict.UNDECIDED, Verdict.SUPPORTED
ELSEWHERE = {"figure1", "figure2", "figure3", "figure9"}  # shown among results or above

NEEDS = f"""
    summary.csv claims.json outcomes? horizon? {shipped.REFERENCE} {shipped.EFFORTS} {shipped.POWER}
    {shipped.FACTORS} search/{{improved}}.csv runs/{{scenario}}/{{ladder}}.parquet
    ensemble/assignments.improved.parquet ensemble/scaled.improved.parquet
    ensemble/assignments.ritter.parquet seed iterations
"""


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


def _campaign(evidence: Evidence) -> dict:
    """What is said of the alternative setups beside the claims; empty where none is measured."""
    outcomes = evidence.setups("outcomes")
    if outcomes is None:
        return {}
    design, power = evidence.table(shipped.DESIGN), evidence.table(shipped.POWER)
    none = power[(power["effect"] == 1) & (power["heterogeneity"] == 0)].iloc[0]
    found = power[power["heterogeneity"] == 0].set_index("effect")["supported"]
    smallest = found[found >= ENOUGH].index.max()
    among = power[power["effect"] == smallest].set_index("heterogeneity")["supported"]
    own = power[power["effect"] == 1].set_index("heterogeneity")["found"]
    assumed = math.sqrt(statistics.fmean(luck**2 for luck in ASSUMED_LUCK.values()))
    return {
        "setups": outcomes["universe"].nunique(),
        "replicates": outcomes["replicate"].nunique(),
        "factors": evidence.levels().shape[1],
        "homes": design["homes_refused"].sum(),
        "power": power.to_dict("records"),
        "none": none,
        "smallest_effect": 1 - smallest,
        "found_among": {"heterogeneity": among.index.max(), "share": among[among.index.max()]},
        "smallest_heterogeneity": own[own >= ENOUGH].index.min(),
        "assumed": ASSUMED_LUCK,
        "assumed_luck": assumed,
        "luckier": [claim for claim in evidence.claims() if _luckier(claim, assumed)],
    }


def _luckier(claim: dict, assumed: float) -> bool:
    """Whether luck may have hidden what a comparison asks: more than its power was computed for."""
    home, its = _home(claim), claim["universes"]
    compares = all(across.comparison == RATIO for across in home.across.values())
    return compares and claim["verdict"] != Verdict.SUPPORTED and its.get("luck", 0) > assumed


def _home(claim: dict) -> Claim:
    return next(its for its in CLAIMS if its.id == claim["id"])


def _said(claim: dict) -> dict:
    """A judged claim, with what its home says of it besides."""
    home = _home(claim)
    numbers = [figure.removeprefix("figure") for figure in home.figures]
    return claim | {
        "reason": home.reason.format(**home.limits),
        "figures": f"Figure{'s' * (len(numbers) > 1)} {' and '.join(numbers)}" if numbers else "",
    }


def _where(factors: Words, row: dict) -> dict:
    words = factors[row["factor"]]
    answer = level_in_words(words, row["level"])
    return row | {
        "asks": words["asks"],
        "answer": answer,
        "where": f"{words['asks']} {answer}",
    }


def figures() -> list[str]:
    """The figures that show the claims, without those that all results show."""
    named = {figure for claim in CLAIMS for figure in claim.figures} - ELSEWHERE
    return sorted(named, key=lambda name: int(name.removeprefix("figure")))


def context(evidence: Evidence) -> dict:
    """Everything that the page may say."""
    summary, scaled = (
        evidence.table("summary.csv"),
        evidence.table(f"ensemble/scaled.{IMPROVED}.parquet"),
    )
    reference = evidence.table(shipped.REFERENCE)
    ensembles = [
        evidence.table(f"ensemble/assignments.{learner}.parquet") for learner in (IMPROVED, RITTER)
    ]
    ritter = summary.loc[summary["learner"] == RITTER, "iterations"]
    improved, by_level = evidence.facts["improved"], parts(evidence)
    sample, searched_for = evidence.sample(improved), evidence.sought(improved)
    return {
        "depends": partial(depends, evidence.words()),
        "campaign": _campaign(evidence),
        "claims": [_said(claim) for claim in evidence.claims()],
        "groups": [str(verdict) for verdict in ORDER],
        "parts": [_where(evidence.words(), row) for row in by_level],
        "otherwise": otherwise(by_level),
        "factors": factor_table(evidence),
        "in_setups": in_setups(evidence),
        "published": PUBLISHED,
        "two_maps": two_maps(reference),
        "speed_of_two_maps": speed_of_two_maps(reference),
        "schedules": schedules(reference),
        "widths": width_order(sample, evidence.rng("exchange of widths")),
        "replicates": len(reference),
        "iterations": evidence.facts["iterations"],
        "ritter_iterations": ritter.max(),
        "figures": figures(),
        "refused": _refused(summary),
        "trials": len(sample) // searched_for.searches,
        "searches": searched_for.searches,
        "ensemble": _ensemble(*ensembles),
        "scaled": _scaled(scaled),
        "scaled_robots": scaled["robot"].nunique(),
    }
