"""Random errors of a simulated arm: its repeatability, measurement noise and outliers."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.damaged.imperfections import Imperfection
from recalib.errors import InvalidSetting, check_kind
from recalib.files import bounded


@dataclass(frozen=True)
class Noise(Imperfection, words=("position_noise", "orientation_noise")):
    """Standard deviations of each measurement of a pose."""

    position_noise: bounded.Noise = 0.0
    """Along each axis."""
    orientation_noise: bounded.NoiseOfTurn = 0.0
    """About each axis."""


@dataclass(frozen=True)
class Repeatability(Imperfection, words=("repeatability",)):
    """Random errors of the joint angles at which an arm stops."""

    repeatability: bounded.NoiseOfTurn = 0.0
    """Standard deviation of the angle at which each joint stops."""


@dataclass(frozen=True)
class Outliers(Imperfection, words=("outlier_share", "outlier_size")):
    """Gross measurement errors in random directions."""

    outlier_share: bounded.Share = 0.0
    """Share of outliers among all measurements."""
    outlier_size: bounded.Amount = 0.0
    """Distance of an outlier from the true position."""


Disturbance = Noise | Repeatability | Outliers


@dataclass(frozen=True)
class Disturbances:
    """Random errors of moves and measurements; none by default.

    Raises InvalidSetting for a field of another type.
    """

    noise: Noise = Noise()
    repeatability: Repeatability = Repeatability()
    outliers: Outliers = Outliers()

    def __post_init__(self) -> None:
        for part in fields(self):
            check_kind(part.name, getattr(self, part.name), type(part.default))

    @classmethod
    def of(cls, parts: Iterable[Disturbance]) -> "Disturbances":
        """Disturbances from a list. Raises InvalidSetting for two of one kind, or another type."""
        by_name: dict[str, Any] = {}
        for part in parts:
            check_kind("disturbance", part, Noise, Repeatability, Outliers)
            name = type(part).__name__.lower()  # also the name of the field
            if name in by_name:
                raise InvalidSetting(name, "there twice", "once in a list of damages")
            by_name[name] = part
        return cls(**by_name)

    def of_joints(
        self, generators: Sequence[np.random.Generator], shape: tuple[int, int]
    ) -> np.ndarray:
        """Random joint errors (run, *shape) [rad], from one generator for each run.

        `shape` is (moves, joints). Errors of sliding joints have no meaning: ignore them.
        """
        return self.repeatability.repeatability * np.stack(
            [generator.standard_normal(shape) for generator in generators]
        )

    def measure(self, generators: Sequence[np.random.Generator], poses: np.ndarray) -> np.ndarray:
        """Measured poses (run, move, 4, 4), with random errors from one generator for each run."""
        moves = poses.shape[1]
        # Draw every number, even if its deviation is zero: runs that differ in one deviation then
        # share all other numbers.
        draws = [
            (rng.standard_normal((3, moves, 3)), rng.uniform(size=(moves, 1))) for rng in generators
        ]
        shift, turn, direction = np.stack([normal for normal, _ in draws], axis=1)
        is_outlier = np.stack([uniform for _, uniform in draws]) < self.outliers.outlier_share
        direction /= np.linalg.norm(direction, axis=-1, keepdims=True)
        gross = self.outliers.outlier_size * direction
        measured = poses.copy()
        measured[..., :3, 3] += self.noise.position_noise * shift + np.where(is_outlier, gross, 0.0)
        turns = Rotation.from_rotvec(self.noise.orientation_noise * turn.reshape(-1, 3)).as_matrix()
        measured[..., :3, :3] = turns.reshape(measured[..., :3, :3].shape) @ poses[..., :3, :3]
        return measured
