"""Laser tracker data of a real arm: tables of positions, downloaded from their public address.

A description defines their columns and frames (`recalib.laboratory.tables.description`).
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
    """The tracker's measurements, in the conventions of the URDF."""

    angles: np.ndarray  # (n, 6) rad, commanded
    # (n, 3) m in the base frame, nominal positions of the tool according to the table
    nominal: np.ndarray
    measured: np.ndarray  # (n, 3) m in the base frame, measured positions

    def __len__(self) -> int:
        return len(self.angles)

    def __getitem__(self, rows: Any) -> "TrackerMeasurements":
        return TrackerMeasurements(self.angles[rows], self.nominal[rows], self.measured[rows])


def read_whole_description(path: str | PathLike[str]) -> Description:
    """The description of such tables at `path`.

    Raises InvalidFile, also if the frame of the instrument or of the target is missing.
    """
    description = read_description(path)
    if description.instrument is None or description.target is None:
        raise InvalidFile(path, "its instrument or its target is missing; expected: both")
    return description


def read_of(arm: Arm, path: str | PathLike[str], description: Description) -> TrackerMeasurements:
    """The measurements in the table at `path`, checked to be of this arm.

    Args:
        arm: the nominal arm, with its tool at the measured point.
        description: the description of the table, with the frame of the instrument.

    Raises InvalidFile (an unusable table) and Mistaken (another arm or other units: the arm does
    not reach the nominal positions in the table).
    """
    rows = read_measurements(path, arm, description)
    nominal = rows.columns.get(NOMINAL.name)
    if rows.joints is None or rows.positions is None or nominal is None:
        raise InvalidFile(
            path, f"{', '.join(NOMINAL.headings)} or measured positions are missing; expected: both"
        )
    instrument = description.instrument
    assert instrument is not None  # `read_whole_description` has both frames
    check_nominal(arm, rows.joints, nominal, np.linalg.inv(instrument), np.eye(4))
    turn, place = instrument[:3, :3], instrument[:3, 3]
    return TrackerMeasurements(
        rows.joints, nominal @ turn.T + place, rows.positions @ turn.T + place
    )


def fetch(study: Study) -> tuple[bytes, bytes]:
    """The tables of the real arm, to learn from and to test on. Raises like `fetched`."""
    return fetched(study.real.data.fit), fetched(study.real.data.test)


def fetched(source: Source) -> bytes:
    """A table, from a file or from its public address.

    Raises RecalibError if it cannot be read, or if its checksum is wrong.
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
            f"{where} is out of reach ({error}); try: set `file` in real.data to"
            " the path of a copy on this machine"
        ) from None
    digest = hashlib.sha256(content).hexdigest()
    if digest != source.sha256:
        raise RecalibError(f"{where} has SHA-256 {digest}; expected {source.sha256}")
    return content
