"""What the page of all results says: every claim as measured, and every training."""

import numpy as np

from replication.config.switches import RITTER
from replication.judgement.factor import CELLS
from replication.judgement.intervals import first_within
from replication.judgement.results import Evidence
from replication.pages.readme import in_a_sentence
from replication.pages.words import one, typical_errors
from replication.training.measured import ERRORS, UNITS

NEEDS = """
    runs/{scenario}/{improved}.parquet runs/{scenario}/{ritter}.parquet
    summary.csv claims.json published iterations
"""


def _on_its_way(evidence: Evidence) -> str:
    """After how many iterations of its one long training Ritter's has the improved one's errors.

    It is what Figure 2 says.
    """
    improved, ritter = (
        evidence.history(learner).groupby("iteration")[list(ERRORS)].mean()
        for learner in (evidence.facts["improved"], evidence.facts["ritter"])
    )
    first = first_within(ritter.index.to_numpy(), ritter.to_numpy(), improved.iloc[-1].to_numpy())
    if not np.isfinite(first):
        return f"in none of its {ritter.index[-1]:,} iterations"
    return f"after {first:,.0f} iterations"


def context(evidence: Evidence) -> dict:
    """Everything that the page may say."""
    summary, claims = evidence.table("summary.csv").to_dict("records"), evidence.claims()
    rows = {(row["scenario"], row["learner"]): row for row in summary}
    by_id = {claim["id"]: claim for claim in claims}
    return {
        "setups": max(claim["universes"].get("setups", 0) for claim in claims),
        "own": rows[evidence.facts["scenario"], evidence.facts["improved"]],
        "typical": typical_errors(by_id["figure-1"]),
        "published": " and ".join(
            f"{evidence.facts['published'][error]:g} {unit}"
            for error, unit in zip(ERRORS, UNITS, strict=True)
        ),
        "claims": claims,
        "sentences": in_a_sentence(by_id),
        "summary": summary,
        "on_its_way": _on_its_way(evidence),
        "tuned_anew": one(by_id["speed-up"], f"factor, as many cells as {CELLS[RITTER]}"),
        "iterations": evidence.facts["iterations"],
    }
