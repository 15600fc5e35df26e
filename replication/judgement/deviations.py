"""The registration before the campaign, and deviations: later changes, each with an entry.

`python -m replication.judgement.deviations` prints the digests that a new entry must contain.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Literal, Self

from pydantic import Field

from recalib.files.storage import digest
from replication.config.part import Frozen
from replication.config.reading import read_study
from replication.config.shipped import DEVIATIONS
from replication.config.study import Study
from replication.config.values import from_file
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
REMOVED = "removed"  # in place of the digest of a part that was removed


def digests(study: Study, project: Path) -> dict[str, str]:
    """Digests of all claims, parts of the configuration and files that determine verdicts."""
    found = {claim.id: digest(repr(claim.registered).encode()) for claim in claims(study)}
    for part in PARTS:
        found[f"config.yaml: {part}"] = digest(repr(getattr(study, part)).encode())
    return found | {name: digest((project / name).read_bytes()) for name in FILES}


class Change(Frozen):
    """A change after a result had been seen."""

    when: str  # the time of the commit, in UTC
    commit: str  # the commit with the change
    what: str  # what was changed
    verdict: str  # the effect on verdicts


class Deviation(Change):
    """A change of the registration of the campaign in force."""

    kind: Literal["criterion", "choice", "design", "code"]  # kind of change
    # the registered and the present version
    before: str
    after: str
    why: str  # the reason
    seen: str  # the results that were known at the time
    # the new digests of the changed parts, by name, or `REMOVED`
    digests: dict[str, str] = Field(default={})


class Withdrawn(Frozen):
    """Changes during an earlier campaign, which no longer determines verdicts."""

    campaign: str
    changes: tuple[Change, ...]


class Deviations(Frozen):
    """The digests of the registration, and all changes, in chronological order."""

    registered: dict[str, str]  # digests by name
    deviations: tuple[Deviation, ...]  # changes during the campaign in force
    withdrawn: tuple[Withdrawn, ...]  # earlier campaigns, the latest one first

    @classmethod
    def read(cls, project: Path = Path()) -> Self:
        """Read the deviations of the project in a folder."""
        return cls.model_validate(from_file(project / DEVIATIONS).plain())

    def undeclared(self, today: Mapping[str, str]) -> dict[str, str]:
        """Today's digests that no entry contains, and `REMOVED` for parts that no longer exist."""
        declared = dict(self.registered)
        for deviation in self.deviations:
            declared |= deviation.digests
        gone = {name for name, digest in declared.items() if digest != REMOVED} - {*today}
        changed = {name: digest for name, digest in today.items() if declared.get(name) != digest}
        return changed | dict.fromkeys(sorted(gone), REMOVED)


if __name__ == "__main__":
    _today = digests(read_study(Path("config.yaml")), Path())
    for _name, _digest in Deviations.read().undeclared(_today).items():
        print(f'"{_name}": "{_digest}"')
