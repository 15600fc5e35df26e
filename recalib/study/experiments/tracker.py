"""What a laser tracker saw of a real UR5: a table of positions, fetched from its public address.

The table (CSV) has a row for each pose: joint_1 to joint_6 [deg] as commanded, x_t, y_t, z_t [mm]
where the nominal kinematics put the tool, and x_dif, y_dif, z_dif [mm] by how much it was measured
to be beside that. The joints' zero is that of the URDF; the manufacturer's base stands turned by
half a turn about the vertical axis of the URDF's.
"""

import hashlib
import shutil
import urllib.request
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

import numpy as np
import pandas as pd

from recalib.errors import InvalidSetting, RecalibError
from recalib.study import jobs

ANGLES = [f"joint_{number}" for number in range(1, 7)]
NOMINAL, MISSED = (["x_t", "y_t", "z_t"], ["x_dif", "y_dif", "z_dif"])
TO_URDF_BASE = np.array([-1.0, -1.0, 1.0])
PATIENCE = 60  # seconds for the public address to answer


class WrongData(RecalibError):
    """Measurements of the real arm that cannot be had, or are not those that are meant."""


@dataclass(frozen=True)
class Measurements:
    """What the tracker saw, in the conventions of the URDF.

    Attributes:
        angles: (n, 6) rad that were commanded.
        nominal: (n, 3) m in the base frame, where the table says that the tool should have been.
        measured: (n, 3) m in the base frame, where it was.
    """

    angles: np.ndarray
    nominal: np.ndarray
    measured: np.ndarray

    def __len__(self) -> int:
        return len(self.angles)

    def __getitem__(self, rows) -> "Measurements":
        return Measurements(self.angles[rows], self.nominal[rows], self.measured[rows])


def read_measurements(path: str | PathLike) -> Measurements:
    """The measurements in the table at `path`.

    Raises InvalidSetting where a column is missing or holds anything but finite numbers.
    """
    table = pd.read_csv(path)
    for column in (*ANGLES, *NOMINAL, *MISSED):
        if (
            column not in table
            or table.empty
            or not np.isfinite(pd.to_numeric(table[column], errors="coerce")).all()
        ):
            raise InvalidSetting(
                f"column of {path}", column, "there, with a finite number in every row"
            )
    nominal = table[NOMINAL].to_numpy() * 1e-3 * TO_URDF_BASE
    missed = table[MISSED].to_numpy() * 1e-3 * TO_URDF_BASE
    return Measurements(np.radians(table[ANGLES].to_numpy()), nominal, nominal + missed)


def fetch(job: jobs.RealData, path: Path) -> None:
    """Bring a table to `path`, from a file or from its public address.

    Raises WrongData where it is out of reach or not the one that is meant.
    """
    source = job.source
    try:
        if source.file:
            shutil.copy(source.file, path)
        else:
            with urllib.request.urlopen(source.url, timeout=PATIENCE) as reply:
                path.write_bytes(reply.read())
    except OSError as error:
        raise WrongData(
            f"{source.file or source.url} is out of reach ({error}); a copy on this machine can be"
            " named in real.data, as `file`"
        ) from None
    found = hashlib.sha256(path.read_bytes()).hexdigest()
    if found != source.sha256:
        where = source.file or source.url
        raise WrongData(f"{where} has SHA-256 {found}; expected {source.sha256}")
