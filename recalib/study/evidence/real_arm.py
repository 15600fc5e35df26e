"""What the page of the real arm says."""

from recalib.study.competitors import label_of
from recalib.study.evidence.needs import Request
from recalib.study.evidence.real import ERROR
from recalib.study.evidence.results import Evidence

TWIN = "twin"  # is part of the name of a learner that was run on it


def needs(ask: Request) -> None:
    """What the page reads."""
    ask.files("real.csv")
    ask.facts("real_robot", "published_mm", "real_poses")


def context(evidence: Evidence) -> dict:
    """Everything that the page may say."""
    table, published = evidence.table("real.csv"), evidence.fact("published_mm")
    errors: dict[str, dict[int, str]] = {}
    for row in table.to_dict("records"):
        name, _, twin = row["learner"].partition(" ")
        its = errors.setdefault(f"{label_of(name)} {twin}".strip(), {})
        its[row["poses"]] = f"{row[ERROR]:.3f}"
    return {
        "robot": evidence.fact("real_robot").upper(),
        "before": published["before_mm"],
        "after": published["after_mm"],
        "poses": evidence.fact("real_poses"),
        "errors": errors,
        "ends": {name: max(its.items()) for name, its in errors.items() if TWIN in name},
        "subsets": table["subsets"].max(),
    }
