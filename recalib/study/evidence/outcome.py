"""What came out of a study, for a terminal: errors, verdicts, and where to look on."""

from collections.abc import Mapping

from tabulate import tabulate

from recalib.study.evidence.results import Evidence
from recalib.study.evidence.words import amounts, headline, pair, verdicts

NEEDS = "summary.csv claims.json scenarios/{scenario}.json"
WIDE = 60  # characters of a column


def outcome(evidence: Evidence) -> str:
    """The text."""
    resolved, claims = evidence.scenario(), evidence.claims()
    damage = "; ".join(map(amounts, resolved["damages"])) or "no damage"
    parts = [
        f"{evidence.study}: {resolved['robot'].upper()}, {damage}",
        _table(_errors(row) for row in evidence.table("summary.csv").to_dict("records")),
        _table(map(_verdict, claims)) if claims else "No claim of the paper is about this.",
        f"Figures and recordings are in {evidence.root}; to watch the arm: make view"
        f" STUDY={evidence.study}, or make web STUDY={evidence.study} for a browser.",
    ]
    return "\n\n".join(parts) + "\n"


def _errors(row: Mapping) -> dict[str, str]:
    return {
        "scenario": row["scenario"],
        "learner": row["learner"],
        "before": pair(row, "initial"),
        "after": pair(row, "final"),
    }


def _verdict(claim: Mapping) -> dict[str, str]:
    return {
        "the paper": claim["statement"],
        "here": verdicts(claim).replace("*", ""),
        "measured": headline(claim),
    }


def _table(rows) -> str:
    return tabulate(list(rows), headers="keys", maxcolwidths=WIDE)
