"""Sessions of simulated arms whose truth is known, with a fault or without."""

import numpy as np
from scipy.interpolate import CubicSpline

from recalib import OFFSETS, Calibration, Observations, initial_frames
from recalib.identification import identify_by_consensus
from recalib.identification.checks.sequence import DRIFT, LAG, Fault, faults
from recalib.identification.model import ErrorModel
from tests.identification.real import Real

MIDDLE, AROUND = np.radians([20, -65, 100, -40, 95, 10]), 0.8  # rad
ROWS = 119


def distances(calibration: Calibration, observations: Observations) -> np.ndarray:
    """Distances (n,) [m] between positions that are predicted and measured."""
    return np.linalg.norm(calibration.residuals(observations)[:, :3], axis=1)


def with_targets(real: Real, postures: int, targets: int = 3) -> Observations:
    """Positions of several targets in each posture."""
    joints = np.repeat(real.postures(postures), targets, axis=0)
    numbers = np.arange(targets * postures) % targets
    return Observations(joints, real.poses(joints, numbers)[:, :3, 3], numbers)


class Session:
    """Rows of a UR10 in the order in which they were measured, with a fault.

    Args:
        kind, size: of the fault: a lag [steps from row to row] or a drift [m]; or none.
        on_a_path: whether rows lie along a path, or anywhere.
        times: of the rows [s], if they have any: a lag is in seconds then.
    """

    def __init__(
        self,
        arm,
        seed: int,
        kind: str = "",
        size: float = 0.0,
        positions: bool = False,
        on_a_path: bool = False,
        rows: int = ROWS,
        times: np.ndarray | None = None,
    ):
        self._arm, rng = arm, np.random.default_rng([seed, 7])
        direction = rng.standard_normal(3)
        direction /= np.linalg.norm(direction)
        count = max(rows // 6, 4) if on_a_path else rows
        joints = MIDDLE + rng.uniform(-AROUND, AROUND, (count, 6))
        if on_a_path:
            along = CubicSpline(np.linspace(0, 1, len(joints)), joints)
            joints = along(np.linspace(0, 1, rows))
        clock = np.arange(rows) if times is None else times
        speeds = np.diff(joints, axis=0, prepend=joints[:1])
        speeds[1:] /= np.diff(clock)[:, None]
        poses = Real(arm, seed).poses(joints - size * (kind == LAG) * speeds)
        if kind == DRIFT:
            poses[:, :3, 3] += size * np.outer(clock / clock[-1], direction)
        measured = poses[:, :3, 3] if positions else poses
        self.observations = Observations(joints, measured, times=times)
        self._frames = initial_frames(arm, self.observations)

    def find_faults(self) -> list[Fault]:
        """Faults that the order of the rows shows."""
        model = ErrorModel(self._arm, OFFSETS, self._frames)
        estimate = identify_by_consensus(model, self.observations)
        geometry = Calibration(model, estimate)
        return faults(geometry, self.observations)
