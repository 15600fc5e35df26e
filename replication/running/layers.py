"""The layers of the code. A job runs again if the code of its layer or of a lower layer changes.

No layer imports a higher layer; `tests/test_imports.py` checks this.
"""

import hashlib
from functools import cache
from pathlib import Path

import recalib
import replication

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
HOMES = {module.__name__: Path(module.__path__[0]) for module in (recalib, replication)}


@cache
def digest(layer: str) -> str:
    """The digest of the code of a layer and all lower layers."""
    hasher = hashlib.sha256()
    for name in LAYERS[: LAYERS.index(layer) + 1]:
        package, *folders = name.split(".")
        for path in sorted(HOMES[package].joinpath(*folders).rglob("*.py")):
            hasher.update(path.read_bytes())
    return hasher.hexdigest()
