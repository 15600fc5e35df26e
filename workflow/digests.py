"""Results that are damaged after they were written are named, not used, and made anew.

A digest of each lies beside it: of what a format checks by itself, flipped bits are read as other
data in a file of Parquet, and in text always. `python -m workflow.digests FOLDER` looks at all
results below a folder.
"""

import hashlib
import sys
from collections.abc import Iterable
from pathlib import Path

from recalib.errors import RecalibError
from recalib.files.storage import whole

FOLDER = ".digests"  # beside the results


class Damaged(RecalibError):
    """Results that are not what was written.

    Attributes:
        paths: of what was removed, so that the next run makes it anew.
    """

    def __init__(self, paths: Iterable[Path]):
        self.paths = list(paths)
        named = ", ".join(map(str, self.paths))
        super().__init__(f"damaged since it was written, and removed: {named}; run again")


def keep(paths: Iterable[str]) -> None:
    """Note what was written."""
    for path in map(Path, paths):
        with whole(_beside(path)) as temporary:
            temporary.write_text(_digest(path), encoding="ascii")


def check(paths: Iterable[str | Path]) -> None:
    """Raise Damaged where a file is not what was written; what nobody noted is not judged."""
    damaged = [path for path in map(Path, paths) if _is_damaged(path)]
    for path in damaged:
        path.unlink()
    if damaged:
        raise Damaged(damaged)


def check_all(folder: str) -> None:
    """Check all results below a folder. Raises Damaged."""
    noted = Path(folder).rglob(f"{FOLDER}/*.sha256")
    paths = (path.parents[1] / path.stem for path in noted)
    check(sorted(path for path in paths if path.exists()))


def _beside(path: Path) -> Path:
    return path.parent / FOLDER / f"{path.name}.sha256"


def _digest(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def _is_damaged(path: Path) -> bool:
    noted = _beside(path)
    return noted.exists() and noted.read_bytes() != _digest(path).encode()


if __name__ == "__main__":
    try:
        check_all(sys.argv[1])
    except Damaged as damaged:
        sys.exit(str(damaged))
