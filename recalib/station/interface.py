"""The interface of a station for live calibration: move, report joint angles, measure, stop."""

from collections.abc import Mapping, Sequence
from typing import Protocol

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.arrays import array_of, check_rotations
from recalib.errors import RecalibError
from recalib.identification.model.optics import Optics


class StationFailed(RecalibError):
    """A failure of a station, to which no further move may be sent."""


class Pictures(Protocol):
    """A reader of pictures as poses of a board, such as `BoardInPictures`, which needs OpenCV."""

    tool_radius: float

    def __call__(self, paths: Sequence[str]) -> tuple[np.ndarray, Optics]:
        """Poses (n, 4, 4) [m] from pictures, and their information, also on the lens."""

    def predict(self, poses: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Predictions for pictures at poses (n, 4, 4) [m]; see `predicted_views`."""


class Station(Protocol):
    """An arm with its controller and a measuring instrument.

    One thread makes the station and calls all methods; `stop` may be called from any thread. An
    optional method `close` is called at the end.
    """

    @property
    def joints(self) -> Sequence[str]:
        """Names of the joints as in the URDF, in the order of all joint angles below."""

    @property
    def limits(self) -> tuple[np.ndarray, np.ndarray]:
        """The lowest and highest angles (joints,) [rad; m if prismatic]."""

    def move(self, angles: np.ndarray, speed: float) -> None:
        """Move to joint angles (joints,) [rad, m] and return when the arm stands still.

        Args:
            speed: of the fastest joint, as a fraction of its limit, in (0, 1].

        Raises StationFailed: the arm did not get there, or touched something.
        """

    def angles(self) -> np.ndarray:
        """The encoders' joint angles (joints,) [rad, m]."""

    def measure(self) -> Mapping[str, float | str] | None:
        """A measurement: the cells of a table's row, by the headings of their columns.

        For example `x [m]`, `y [m]`, `z [m]` and `qx`, `qy`, `qz`, `qw`, or `picture`, the path of
        a file. None if the instrument does not see the target. Raises StationFailed.
        """

    def stop(self) -> None:
        """Stop at once. This method raises nothing and may be called repeatedly at any time."""


def cells_of(pose: np.ndarray) -> dict[str, float | str]:
    """A measured pose (4, 4) [m] as `Station.measure` returns it.

    Raises InvalidSetting: another shape, or no rotation.
    """
    pose = array_of("pose", pose, (4, 4))
    check_rotations("pose", pose)
    numbers = [*pose[:3, 3], *Rotation.from_matrix(pose[:3, :3]).as_quat()]
    names = "x [m]", "y [m]", "z [m]", "qx", "qy", "qz", "qw"
    return dict(zip(names, map(float, numbers), strict=True))
