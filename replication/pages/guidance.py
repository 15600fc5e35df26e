"""What the page of guidance says, taken from the benchmark's tables."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from replication.judgement.results import Evidence
from replication.pages.words import ranged
from replication.training.competitors import label_of, peers
from replication.training.measured import BOTH, ERRORS

if TYPE_CHECKING:
    import pandas as pd

NEEDS = "benchmark.csv benchmark_moves.csv threshold budgets"
WORSE = 1.1  # times the best peer's error is worse
NEGLIGIBLE = 1e-4  # cm and degrees: below it, errors are rounding
FIRST = 4  # moves from which the hybrid is held to be as good as the best peer


def moves_text(reached: "pd.Series") -> str:
    """Moves until errors are within a threshold, with their spread."""
    if not np.isfinite(reached["moves"]):
        return "-"
    bounds = reached["low"], reached["high"]
    return ranged(
        reached["moves"], bounds, lambda value: f"{value:,.0f}" if np.isfinite(value) else "more"
    )


def where_worse(table: "pd.DataFrame", budgets: Sequence[int]) -> list[dict]:
    """Scenarios, budgets and errors at which the hybrid is worse than the best other peer."""
    rows = []
    counted = [budget for budget in budgets if budget >= FIRST]
    of_peers = table[table["learner"].isin([*peers()]) & table["moves"].isin(counted)]
    for (scenario, moves), own in of_peers.groupby(["scenario", "moves"], sort=False):
        for error in ERRORS:
            errors = own.set_index("learner")[error]
            others = errors.drop("hybrid")
            if errors["hybrid"] > max(WORSE * others.min(), NEGLIGIBLE):
                rows.append(
                    {
                        "scenario": scenario,
                        "moves": moves,
                        "error": error.split("_")[0],
                        "hybrid": errors["hybrid"],
                        "best": others.min(),
                        "learner": label_of(others.idxmin()),
                    }
                )
    return rows


def context(evidence: Evidence) -> dict:
    """Everything that the page may say."""
    table, budgets = evidence.table("benchmark.csv"), evidence.facts["budgets"]
    reached, threshold = evidence.table("benchmark_moves.csv"), evidence.facts["threshold"]
    both = reached[(reached["threshold"] == threshold) & (reached["error"] == BOTH)]
    its = both.set_index(["scenario", "learner"])
    learners = list(table["learner"].unique())
    return {
        "shipped": evidence.shipped,
        "threshold": threshold,
        "seeds": table["seeds"].max(),
        "learners": learners,
        "label": label_of,
        "scenarios": list(table["scenario"].unique()),
        "moves": lambda scenario, learner: moves_text(its.loc[(scenario, learner)]),
        "needs": reached.groupby("learner")["needs"].first(),
        "first": FIRST,
        "budget": max(budgets),
        "percent": f"{100 * (WORSE - 1):.0f}",
        "negligible": NEGLIGIBLE,
        "worse": where_worse(table, budgets) if {"hybrid", "geometric"} <= {*learners} else None,
    }
