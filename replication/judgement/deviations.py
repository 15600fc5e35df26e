"""What changed after a result had been seen. Each change of the registration has an entry.

`python -m replication.judgement.deviations` prints the digests that a new entry has to name.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Literal, Self

from pydantic import Field

from replication.config.part import Frozen
from replication.config.reading import read_study
from replication.config.shipped import DEVIATIONS
from replication.config.values import from_file
from replication.judgement.registered import digests

REMOVED = "removed"  # instead of a digest: what is no longer there


class Change(Frozen):
    """A change after a result had been seen."""

    when: str  # the time of the commit, in UTC
    commit: str  # the commit that shows it
    what: str  # what was changed
    verdict: str  # what it did to verdicts


class Deviation(Change):
    """A change of the registration of the campaign in force."""

    kind: Literal["criterion", "choice", "design", "code"]  # what was changed: its kind
    # what was registered, and what counts now
    before: str
    after: str
    why: str  # why it was changed
    seen: str  # which results were known then
    # the new digests of the changed parts, by name, or `REMOVED`
    digests: dict[str, str] = Field(default={})


class Withdrawn(Frozen):
    """Changes during an earlier campaign, which judges nothing today."""

    campaign: str
    changes: tuple[Change, ...]


class Deviations(Frozen):
    """What was registered, and all changes, in the order of time."""

    registered: dict[str, str]  # digests by name
    deviations: tuple[Deviation, ...]  # from the campaign in force
    withdrawn: tuple[Withdrawn, ...]  # earlier campaigns, the latest one first

    @classmethod
    def read(cls, project: Path = Path()) -> Self:
        """Those of the project in a folder."""
        return cls.model_validate(from_file(project / DEVIATIONS).plain())

    def undeclared(self, today: Mapping[str, str]) -> dict[str, str]:
        """Those of today's digests that no entry names, and `REMOVED` for each that is gone."""
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
