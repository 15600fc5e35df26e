"""What came out of a study, for a terminal: errors, verdicts, and where to look on."""

from tabulate import tabulate

from replication.judgement.results import Evidence
from replication.pages.words import amounts, headline, pair, verdicts

NEEDS = "summary.csv claims.json scenarios/{scenario}.json"
WIDE = 60  # characters of a column


def outcome(evidence: Evidence) -> str:
    """The text."""
    resolved = evidence.scenario()
    damage = "; ".join(map(amounts, resolved["damages"])) or "no damage"
    errors = [
        {
            "scenario": row["scenario"],
            "learner": row["learner"],
            "before": pair(row, "initial"),
            "after": pair(row, "final"),
        }
        for row in evidence.table("summary.csv").to_dict("records")
    ]
    judged = [
        {
            "the paper": claim["statement"],
            "here": verdicts(claim).replace("*", ""),
            "measured": headline(claim),
        }
        for claim in evidence.claims()
    ]
    parts = [
        f"{evidence.study}: {resolved['robot'].upper()}, {damage}",
        _table(errors),
        _table(judged) if judged else "No claim of the paper is about this.",
        f"Figures and recordings are in {evidence.root}; to watch the arm: make view"
        f" STUDY={evidence.study}, or make web STUDY={evidence.study} for a browser.",
    ]
    return "\n\n".join(parts) + "\n"


def _table(rows: list[dict[str, str]]) -> str:
    return tabulate(rows, headers="keys", maxcolwidths=WIDE)
