"""What the page of guidance says, taken from the benchmark's tables."""

import numpy as np
import pandas as pd

from recalib.learners.peers import NEEDS
from recalib.study.evidence.results import ERRORS, Evidence
from recalib.study.experiments.benchmark import BLACK_BOX

THRESHOLD = 0.1  # cm and degrees
WORSE = 1.1  # times the best peer's error is worse
NEGLIGIBLE = 1e-4  # cm and degrees: below it, errors are rounding
FIRST = 4  # moves from which the hybrid is held to be as good as the best peer


def moves_text(reached: pd.DataFrame) -> str:
    """Moves until both errors are within the threshold: those of the slower one, with the spread of the seeds."""
    slower = reached.sort_values("moves").iloc[-1]
    if not np.isfinite(slower["moves"]):
        return "-"
    high = f"{slower['high']:,.0f}" if np.isfinite(slower["high"]) else "more"
    return f"{slower['moves']:,.0f} ({slower['low']:,.0f}-{high})"


def where_worse(table: pd.DataFrame, budgets: list[int]) -> list[dict]:
    """Scenarios, budgets and errors at which the hybrid is worse than the best other peer."""
    rows = []
    peers = table[
        table["learner"].isin(NEEDS)
        & table["moves"].isin([each for each in budgets if each >= FIRST])
    ]
    for (scenario, moves), own in peers.groupby(["scenario", "moves"], sort=False):
        for error in ERRORS:
            errors = own.set_index("learner")[error]
            others = errors.drop("hybrid")
            if errors["hybrid"] > max(WORSE * others.min(), NEGLIGIBLE):
                cells = {
                    "scenario": scenario,
                    "moves": moves,
                    "error": error.split("_")[0],
                    "hybrid": errors["hybrid"],
                }
                rows.append(
                    cells | {"best": others.min(), "learner": others.idxmin().replace("_", " ")}
                )
    return rows


def context(evidence: Evidence) -> dict:
    """Everything that the page may say."""
    plan = evidence.config["benchmark"]
    table = pd.read_csv(evidence.results / "benchmark.csv")
    seconds = pd.read_csv(evidence.results / "benchmark_seconds.csv").set_index("learner")[
        "seconds_per_move"
    ]
    reached = pd.read_csv(evidence.results / "benchmark_moves.csv").query("threshold == @THRESHOLD")
    reached = reached.set_index(["scenario", "learner"]).sort_index()
    known = {
        "threshold": THRESHOLD,
        "negligible": NEGLIGIBLE,
        "seeds": plan["seeds"],
        "subsets": evidence.config["real"]["subsets"],
        "learners": plan["learners"],
        "scenarios": plan["scenarios"],
        "moves": lambda scenario, learner: moves_text(reached.loc[[(scenario, learner)]]),
        "needs": {learner: NEEDS.get(learner, BLACK_BOX) for learner in plan["learners"]},
        "seconds": seconds,
        "worse": where_worse(table, plan["moves"]),
        "real": {},
        "ends": {},
        "real_poses": evidence.config["real"]["poses"],
    }
    measured = evidence.results / "real.csv"
    if measured.exists():  # its data may be out of reach
        for row in pd.read_csv(measured).itertuples():
            name, error = row.learner.replace("_", " "), f"{row.position_error_mm:.3f}"
            known["real"].setdefault(name, {})[row.poses] = error
            if "twin" in name:
                known["ends"][name] = (row.poses, error)
    return known
