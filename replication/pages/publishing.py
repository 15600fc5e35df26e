"""Copies figures and pages of the shipped study to where they are committed."""

import shutil
from collections.abc import Sequence
from pathlib import Path

from recalib.files.storage import whole


def publish(sources: Sequence[Path], copies: Sequence[Path]) -> None:
    """Copy each file, whole or not at all: a committed file never disappears."""
    for source, copy in zip(sources, copies, strict=True):
        with whole(copy) as temporary:
            shutil.copyfile(source, temporary)
