"""What the page of deviations says: all that changed after a result had been seen.

`python -m recalib.study.evidence.deviations` prints the digests that a new entry has to name.
"""

import hashlib
import json
from collections.abc import Mapping
from datetime import date, datetime
from pathlib import Path
from typing import Literal, Self

from pydantic import Field

from recalib.study.configuration.part import Frozen
from recalib.study.evidence.claims import CLAIMS
from recalib.study.evidence.needs import Request
from recalib.study.evidence.results import Evidence
from recalib.study.evidence.words import verdicts
from recalib.study.shipped import DESIGN, DEVIATIONS, FIRST

# Beside claims and choices: the designs, the rules and what tells how they are applied.
REGISTERED = (
    f"{FIRST}/design.csv",
    DESIGN,
    "docs/registration.md",
    "recalib/study/evidence/verdicts.py",
)
REMOVED = "removed"  # instead of a digest: what is no longer there
UNJUDGED = {"name", "settings", "expected", "benchmark", "real"}  # keys that no claim reads


class Deviation(Frozen):
    """A change after a result had been seen.

    Attributes:
        when: of the commit (UTC), or the day alone.
        commit: that has the change; none where it is the one that has this entry.
        kind: of what changed.
        what: changed, as a heading.
        before, after: the change.
        why: the reason given for it.
        verdict: what it did to verdicts.
        seen: which results had been seen.
        digests: of what it changed, as it has been since, or `REMOVED`.
    """

    when: date | datetime
    commit: str | None = None
    kind: Literal["criterion", "choice", "verdict", "design"]
    what: str
    before: str
    after: str
    why: str
    verdict: str
    seen: str
    digests: dict[str, str] = Field(default_factory=dict)

    @property
    def day(self) -> str:
        """When, in words."""
        return f"{self.when:%Y-%m-%d %H:%M}" if isinstance(self.when, datetime) else f"{self.when}"


class Reread(Frozen):
    """Claims that were read again.

    Attributes:
        before: their names and verdicts; none where a claim is new.
        now: names of the claims that stand for them.
        why: they are read otherwise.
    """

    before: dict[str, str] = Field(default_factory=dict)
    now: tuple[str, ...] = ()
    why: str = ""


class Deviations(Frozen):
    """The file of deviations.

    Attributes:
        registered: a digest of each criterion, choice and file of a design, by its name.
        deviations: all changes, in the order of time.
        reread: the claims before and after the re-reading of 2026-11-23.
    """

    registered: dict[str, str]
    deviations: tuple[Deviation, ...]
    reread: tuple[Reread, ...]

    @classmethod
    def read(cls, path: str | Path = DEVIATIONS) -> Self:
        """What a file says. Raises InvalidConfiguration or pydantic's ValidationError."""
        from recalib.study.configuration.values import from_file

        return cls.model_validate(from_file(path).plain())

    def unnamed(self, digests: Mapping[str, str]) -> dict[str, str]:
        """Those of today's digests that are not the last ones named here."""
        named = dict(self.registered)
        for deviation in self.deviations:
            named |= deviation.digests
        gone = {name for name, digest in named.items() if digest != REMOVED} - {*digests}
        changed = {name: its for name, its in digests.items() if named.get(name) != its}
        return changed | dict.fromkeys(sorted(gone), REMOVED)


def digests(project: Path) -> dict[str, str]:
    """Today's: of criteria, of the rule of verdicts, of choices and of files of designs."""
    found = {
        claim.id: _digest(json.dumps([claim.statement, claim.criterion, dict(claim.limits)]))
        for claim in CLAIMS
    }
    shipped = json.loads((project / "workflow" / "shipped.json").read_text(encoding="utf-8"))
    found |= {f"config.yaml: {key}": its for key, its in shipped.items() if key not in UNJUDGED}
    for name in REGISTERED:
        found[name] = _digest((project / name).read_text(encoding="utf-8"))
    return found


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def needs(ask: Request) -> None:
    """What the page reads."""
    ask.shipped(DEVIATIONS)
    ask.files("claims.json")


def context(evidence: Evidence) -> dict:
    """Everything that the page may say."""
    told = Deviations.read(evidence.path(DEVIATIONS))
    judged = {claim["id"]: verdicts(claim) for claim in evidence.claims()}
    return {
        "deviations": told.deviations,
        "reread": [
            {
                "before": each.before,
                "now": {name: judged[name] for name in each.now},
                "why": each.why,
            }
            for each in told.reread
        ],
    }


if __name__ == "__main__":
    for _name, _its in Deviations.read().unnamed(digests(Path.cwd())).items():
        print(f'"{_name}": "{_its}"')
