"""A station in Python: a simulated UR10 that is bent, and an instrument somewhere in the room.

recalib live examples/station.py:BentUR10 ur10_robot.urdf --tool tool0 --yes
"""

import numpy as np

from recalib import load_arm


class BentUR10:
    def __init__(self) -> None:
        self.arm, self.rng = load_arm("ur10_robot.urdf", "tool0"), np.random.default_rng(1996)
        self.joints, self.limits = self.arm.joints, (np.full(6, -np.pi), np.full(6, np.pi))
        self.stands = np.array([0, -1.2, 1.9, -2.3, -1.6, 0])

    def move(self, angles: np.ndarray, speed: float) -> None:
        self.stands = angles  # your driver moves here, and raises recalib.StationFailed if it fails

    def angles(self) -> np.ndarray:
        return self.stands

    def position_at(self, angles: np.ndarray) -> np.ndarray:
        bent = angles + np.array([0.01, -0.02, 0.015, 0.01, -0.01, 0])
        return in_room(self.arm.forward(bent[None])[0])

    def measure(self) -> dict[str, float | str]:
        x, y, z = self.position_at(self.stands) + 1e-4 * self.rng.normal(size=3)
        return {"x [m]": x, "y [m]": y, "z [m]": z}

    def stop(self) -> None: ...  # your driver stops here


def in_room(pose: np.ndarray) -> np.ndarray:
    return np.add([[0, 1, 0], [-1, 0, 0], [0, 0, 1]] @ pose[:3, 3], [1.0, 0.5, -0.2])
