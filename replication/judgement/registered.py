"""The registration before the campaign: digests of everything that determines a verdict."""

from pathlib import Path

from recalib.files.storage import digest
from replication.config.study import Study
from replication.judgement.claims import claims

# Code and tables that determine a number, an interval or a verdict.
FILES = (
    "docs/registration.md",
    "workflow/campaign/design.csv",
    "replication/training/search.py",
    "replication/training/settings.py",
    "replication/training/trials.py",
    "replication/campaign/measuring.py",
    "replication/campaign/variants.py",
    "replication/judgement/contrasts.py",
    "replication/judgement/hierarchy.py",
    "replication/judgement/verdicts.py",
)
PARTS = (
    "seed",
    "robot",
    "scenario",
    "robots",
    "controller",
    "paper_damage",
    "scenarios",
    "learners",
    "mapping",
    "search",
    "campaign",
)


def digests(study: Study, project: Path) -> dict[str, str]:
    """Digests of all claims, parts of the configuration and files that determine verdicts."""
    found = {claim.id: digest(repr(claim.registered).encode()) for claim in claims(study)}
    for part in PARTS:
        found[f"config.yaml: {part}"] = digest(repr(getattr(study, part)).encode())
    return found | {name: digest((project / name).read_bytes()) for name in FILES}
