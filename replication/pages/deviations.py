"""What the page of deviations says: all that changed after a result had been seen.

`python -m replication.pages.deviations` prints the digests that a new entry has to name.
"""

import json
from collections.abc import Mapping
from pathlib import Path

from recalib.files.storage import digest
from replication.config.shipped import DESIGN, DEVIATIONS, FIRST
from replication.config.values import from_file
from replication.judgement.claims import CLAIMS
from replication.judgement.results import Evidence
from replication.pages.words import verdicts

# Beside claims and choices: the designs, the rules and what tells how they are applied.
REGISTERED = (
    f"{FIRST}/design.csv",
    DESIGN,
    "docs/registration.md",
    "replication/judgement/verdicts.py",
    "replication/campaign/measuring.py",
)
NEEDS = f"{DEVIATIONS} claims.json"
REMOVED = "removed"  # instead of a digest: what is no longer there
UNJUDGED = {"name", "settings", "expected", "benchmark", "real"}  # keys that no claim reads


def unnamed(told: Mapping, digests: Mapping[str, str]) -> dict[str, str]:
    """Those of today's digests that are not the last ones named in the file of deviations.

    Args:
        told: what it says: `registered`, a digest of each criterion, choice and file of a design;
            `deviations`, with the digests of what each changed, as it has been since, or `REMOVED`.
    """
    named = dict(told["registered"])
    for deviation in told["deviations"]:
        named |= deviation.get("digests", {})
    gone = {name for name, digest in named.items() if digest != REMOVED} - {*digests}
    changed = {name: its for name, its in digests.items() if named.get(name) != its}
    return changed | dict.fromkeys(sorted(gone), REMOVED)


def digests(project: Path) -> dict[str, str]:
    """Today's: of criteria, of the rule of verdicts, of choices and of files of designs."""
    found = {
        claim.id: digest(
            json.dumps([claim.statement, claim.criterion, dict(claim.limits)]).encode()
        )
        for claim in CLAIMS
    }
    shipped = json.loads((project / "workflow" / "shipped.json").read_text(encoding="utf-8"))
    found |= {f"config.yaml: {key}": its for key, its in shipped.items() if key not in UNJUDGED}
    for name in REGISTERED:
        found[name] = digest((project / name).read_bytes())
    return found


def context(evidence: Evidence) -> dict:
    """Everything that the page may say."""
    told = from_file(evidence.files[DEVIATIONS]).plain()
    judged = {claim["id"]: verdicts(claim) for claim in evidence.claims()}
    return {
        "deviations": told["deviations"],
        "reread": [
            {"before": {}, "why": ""} | its | {"now": {name: judged[name] for name in its["now"]}}
            for its in told["reread"]
        ],
    }


if __name__ == "__main__":
    for _name, _its in unnamed(from_file(DEVIATIONS).plain(), digests(Path.cwd())).items():
        print(f'"{_name}": "{_its}"')
