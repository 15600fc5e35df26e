"""Laser tracker data of a real arm: tables of positions, fetched from their public address.

A description has their columns and frames (`recalib.laboratory.tables.description`).
"""

import hashlib
import urllib.request
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from recalib.errors import InvalidFile, RecalibError
from recalib.laboratory.plausibility.mistakes import check_nominal
from recalib.laboratory.tables.columns import NOMINAL
from recalib.laboratory.tables.description import Description, read_description
from recalib.laboratory.tables.measurements import read_measurements
from recalib.nominal.kinematics import Arm
from replication.config.study import Source, Study

PATIENCE = 60  # seconds for the public address to answer


@dataclass(frozen=True)
class TrackerMeasurements:
    """What the tracker saw, in the conventions of the URDF."""

    angles: np.ndarray  # (n, 6) rad that were commanded
    # (n, 3) m in the base frame, where the table says that the tool should have been
    nominal: np.ndarray
    measured: np.ndarray  # (n, 3) m in the base frame, where it was

    def __len__(self) -> int:
        return len(self.angles)

    def __getitem__(self, rows: Any) -> "TrackerMeasurements":
        return TrackerMeasurements(self.angles[rows], self.nominal[rows], self.measured[rows])


def read_whole_description(path: str | PathLike[str]) -> Description:
    """The description of such tables at `path`.

    Raises InvalidFile, also where it says not where the instrument stands or the target sits.
    """
    description = read_description(path)
    if description.instrument is None or description.target is None:
        raise InvalidFile(path, "its instrument or its target is missing; expected: both")
    return description


def read_of(arm: Arm, path: str | PathLike[str], description: Description) -> TrackerMeasurements:
    """The measurements in the table at `path`, of this arm and no other.

    Args:
        arm: the nominal arm, its tool at the point that was measured.
        description: what the table does not say itself, with where the instrument stands.

    Raises InvalidFile (a table that cannot be used) and Mistaken (another arm, or other units:
    it does not get to the nominal positions in the table).
    """
    rows = read_measurements(path, arm, description)
    nominal = rows.columns.get(NOMINAL.name)
    if rows.joints is None or rows.positions is None or nominal is None:
        raise InvalidFile(
            path, f"it lacks {', '.join(NOMINAL.headings)} or what was measured; expected: both"
        )
    instrument = description.instrument
    assert instrument is not None  # `read_whole_description` has both frames
    check_nominal(arm, rows.joints, nominal, np.linalg.inv(instrument), np.eye(4))
    turn, place = instrument[:3, :3], instrument[:3, 3]
    return TrackerMeasurements(
        rows.joints, nominal @ turn.T + place, rows.positions @ turn.T + place
    )


def fetch(study: Study) -> tuple[bytes, bytes]:
    """The tables of the real arm: to learn from, and to test on. See `fetched` for its errors."""
    return fetched(study.real.data.fit), fetched(study.real.data.test)


def fetched(source: Source) -> bytes:
    """A table, from a file or from its public address.

    Raises RecalibError where it is out of reach or not the one that is meant.
    """
    where = source.file or source.url
    try:
        if source.file:
            content = Path(source.file).read_bytes()
        else:
            with urllib.request.urlopen(source.url, timeout=PATIENCE) as reply:
                content = reply.read()
    except OSError as error:
        raise RecalibError(
            f"{where} is out of reach ({error}); a copy on this machine can be"
            " named in real.data, as `file`"
        ) from None
    digest = hashlib.sha256(content).hexdigest()
    if digest != source.sha256:
        raise RecalibError(f"{where} has SHA-256 {digest}; expected {source.sha256}")
    return content
