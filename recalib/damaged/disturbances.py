"""What keeps a real arm from repeating itself and a real instrument from measuring it exactly."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.errors import InvalidSetting


@dataclass(frozen=True)
class Disturbances:
    """Random errors of a move and of its measurement; all zero unless given.

    Args:
        position_noise: m, standard deviation of the measured position along each axis.
        orientation_noise: rad, standard deviation of the measured orientation about each axis.
        repeatability: rad, standard deviation of the angle at which each joint stops.
        outlier_fraction: of the measurements that are grossly wrong, from 0 to 1.
        outlier_size: m by which these miss the true position, in a random direction.

    Raises InvalidSetting.
    """

    position_noise: float = 0.0
    orientation_noise: float = 0.0
    repeatability: float = 0.0
    outlier_fraction: float = 0.0
    outlier_size: float = 0.0

    def __post_init__(self):
        for field in fields(self):
            value, greatest = (
                getattr(self, field.name),
                1 if field.name == "outlier_fraction" else math.inf,
            )
            if not (0 <= value <= greatest and math.isfinite(value)):
                valid = "from 0 to 1" if greatest == 1 else "a finite number from 0 on"
                raise InvalidSetting(field.name, value, valid)

    def of_joints(self, generators: Sequence[np.random.Generator], moves: int) -> np.ndarray:
        """By how much each joint stops beside its angle, (run, move, 6) rad; a generator for each run."""
        return self.repeatability * np.stack(
            [generator.standard_normal((moves, 6)) for generator in generators]
        )

    def measure(self, generators: Sequence[np.random.Generator], poses: np.ndarray) -> np.ndarray:
        """What the instrument says of the poses (run, move, 4, 4); a generator for each run."""
        moves = poses.shape[1]
        # Every number is drawn whatever the sizes are: runs that differ in one size share all the rest of their luck.
        luck = [
            (each.standard_normal((3, moves, 3)), each.uniform(size=(moves, 1)))
            for each in generators
        ]
        shift, turn, direction = np.stack([normal for normal, _ in luck], axis=1)
        is_outlier = np.stack([uniform for _, uniform in luck]) < self.outlier_fraction
        gross = self.outlier_size * direction / np.linalg.norm(direction, axis=-1, keepdims=True)
        measured = poses.copy()
        measured[..., :3, 3] += self.position_noise * shift + np.where(is_outlier, gross, 0.0)
        turns = Rotation.from_rotvec(self.orientation_noise * turn.reshape(-1, 3)).as_matrix()
        measured[..., :3, :3] = turns.reshape(measured[..., :3, :3].shape) @ poses[..., :3, :3]
        return measured
