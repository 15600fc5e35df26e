"""An identified arm in one self-contained file: enough to correct commands.

The file is an archive (`recalib.files.archives`). Its header holds the format's version, the
nominal arm's base and tool link and the names of the targets. Its arrays are the bytes of the arm's
URDF, the calibration's, and the joint coordinates learned from.
"""

from dataclasses import dataclass
from os import PathLike
from pathlib import Path

import numpy as np

from recalib.files.archives import read_archive, refused, write_archive
from recalib.identification.calibration import Calibration
from recalib.nominal.arms import arm_of
from recalib.nominal.kinematics import Arm

FORMAT, WRITER = ("recalib correction", 4), "recalib calibrate"


@dataclass(frozen=True)
class Correction:
    """An identified arm, and the postures in which it was measured.

    Attributes:
        urdf: of the nominal arm, as the user gave it.
        calibration: of it.
        learned: (n, joints) rad, or m where a joint slides, from which it was identified.
        targets: their names, in the order of their numbers.
    """

    urdf: bytes
    calibration: Calibration
    learned: np.ndarray
    targets: tuple[str, ...] = ("the target",)

    @property
    def arm(self) -> Arm:
        """The nominal arm."""
        return self.calibration.model.nominal

    def save(self, path: str | PathLike[str]) -> None:
        """Write it, whole or not at all."""
        header = {
            "format": FORMAT[0],
            "version": FORMAT[1],
            "tool": self.arm.tool,
            "base": self.arm.base,
            "targets": self.targets,
        }
        urdf = np.frombuffer(self.urdf, dtype=np.uint8)  # in whichever encoding it is
        state = {"urdf": urdf, "learned": self.learned, "calibration": self.calibration.state()}
        write_archive(path, header, state)


def load_correction(path: str | PathLike[str]) -> Correction:
    """What `Correction.save` wrote. Raises InvalidFile."""
    header, state = read_archive(path, FORMAT, WRITER)
    with refused(path, WRITER):
        urdf = state["urdf"].tobytes()
        arm = arm_of(urdf, Path(path), header["tool"], header["base"])
        calibration = Calibration.restore(arm, state["calibration"])
        loaded = Correction(urdf, calibration, state["learned"], tuple(header["targets"]))
        if not _fits(loaded):
            raise ValueError
    return loaded


def _fits(correction: Correction) -> bool:
    """Whether the parts belong to one another; where they do not, it may raise anything."""
    calibration, learned = correction.calibration, correction.learned
    estimate, frames = calibration.estimate, calibration.model.frames
    sights, ends = frames.sights, (len(frames.bases), len(frames.targets))
    if not len(sights) or sights.dtype != int or ((sights < 0) | (sights >= ends)).any():
        return False
    unknown = estimate.parameters @ estimate.covariance @ estimate.parameters
    estimated = unknown, estimate.parameters, estimate.covariance, estimate.noise, estimate.weights
    numbers = learned, *calibration.forward_and_jacobian(learned[:1]), *estimated
    return learned.shape[1:] == (len(correction.arm.joints),) and all(
        array.size and array.dtype == float and np.isfinite(array).all() for array in numbers
    )
