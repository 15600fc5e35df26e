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
    """A change after a result had been seen.

    Attributes:
        when: the time of the commit, in UTC.
        commit: that shows it.
        what: was changed.
        verdict: what it did to verdicts.
    """

    when: str
    commit: str
    what: str
    verdict: str


class Deviation(Change):
    """A change of the registration of the campaign in force.

    Attributes:
        kind: of the change.
        before, after: what was registered, and what counts now.
        why: it was changed.
        seen: the results that were known.
        digests: of the changed parts, by name, since then, or `REMOVED`.
    """

    kind: Literal["criterion", "choice", "design", "code"]
    before: str
    after: str
    why: str
    seen: str
    digests: dict[str, str] = Field(default={})


class Withdrawn(Frozen):
    """Changes during an earlier campaign, which judges nothing today."""

    campaign: str
    changes: tuple[Change, ...]


class Deviations(Frozen):
    """What was registered, and all changes, in the order of time.

    Attributes:
        registered: digests by name.
        deviations: from the campaign in force.
        withdrawn: earlier campaigns, the latest one first.
    """

    registered: dict[str, str]
    deviations: tuple[Deviation, ...]
    withdrawn: tuple[Withdrawn, ...]

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
