"""The layers of the code. A job runs again if the code of its layer or of a lower layer changes.

No layer imports a higher layer; `tests/test_imports.py` checks this.
"""

import hashlib
from functools import cache
from pathlib import Path

LAYERS = (
    "recalib",
    "replication.config",
    "replication.scenarios",
    "replication.training",
    "replication.mapping",
    "replication.campaign",
    "replication.judgement",
    "replication.plots",
    "replication.recording",
    "replication.pages",
)
PROJECT = Path(__file__).parents[2]


@cache
def digest(layer: str) -> str:
    """The digest of the code of a layer and all lower layers."""
    hasher = hashlib.sha256()
    for name in LAYERS[: LAYERS.index(layer) + 1]:
        for path in sorted(PROJECT.joinpath(*name.split(".")).rglob("*.py")):
            hasher.update(path.read_bytes())
    return hasher.hexdigest()
