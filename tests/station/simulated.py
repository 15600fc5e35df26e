"""Stations that are simulated: an arm that is off, where its encoders do not say so."""

import zlib
from functools import cache

import numpy as np

from recalib import Arm, load_arm
from recalib.station import cells_of
from tests.identification.real import ARMS, NOISE, Real

HOMES = {"Panda": [0, 0.2, 0, -2, 0, 2.2, 0.8]}  # rad
HOMES |= {name: [0, -1.2, 1.9, -2.3, -1.6, 0] for name in ("UR5", "UR10")}
URDFS = ARMS | {"UR5": ("ur5_robot.urdf", "tool0")}


@cache
def known_arm(name: str) -> Arm:
    return load_arm(*URDFS[name])


class Simulated:
    """An arm, and an instrument that sees its target in all postures.

    What is measured in a posture is the same each time. All calls are noted.
    """

    def __init__(self, name: str = "UR10", seed: int = 1, noise=NOISE):
        self.arm = known_arm(name)
        self.real, self.noise = Real(self.arm, seed), noise
        self.joints = self.arm.joints
        model = self.arm.model
        self.limits = model.lowerPositionLimit, model.upperPositionLimit
        self.stands, self.calls = np.array(HOMES[name], dtype=float), []
        self.moves = []  # to which angles, and how fast

    def move(self, angles, speed):
        self.calls.append("move")
        self.moves.append((angles, speed))
        self.stands = angles

    def angles(self):
        return self.stands

    def pose(self):
        self.real.random = np.random.default_rng(zlib.crc32(np.round(self.stands, 6).tobytes()))
        return self.real.poses(self.stands[None], noise=self.noise)[0]

    def measure(self):
        self.calls.append("measure")
        return cells_of(self.pose())

    def stop(self):
        self.calls.append("stop")


class Ordered(Simulated):
    """One whose joints stand in another order: a cycle of three, which is not its own inverse."""

    ORDER = np.array([1, 2, 0, 4, 5, 3])

    def __init__(self):
        super().__init__()
        self.joints = [self.arm.joints[joint] for joint in self.ORDER]
        self.limits = [limit[self.ORDER] for limit in self.limits]

    def move(self, angles, speed):
        own = np.empty_like(angles)
        own[self.ORDER] = angles
        super().move(own, speed)

    def angles(self):
        return self.stands[self.ORDER]

    def measure(self):  # also its cells are in another order, from the second row on
        cells = super().measure()
        return cells if self.calls.count("measure") == 1 else dict(reversed(cells.items()))


class Spoilt(Simulated):
    """One that does something of its own.

    Args:
        moved: called with it after its third move.
        angles: called with it and the angles at which it stands; what it returns for them.
        measured: called with it and the cells of a measurement; what it returns for them.
        attributes: of it, in place of its own.
    """

    def __init__(
        self,
        moved=lambda station: None,
        angles=lambda station, angles: angles,
        measured=lambda station, cells: cells,
        **attributes,
    ):
        super().__init__()
        self.moved, self.changed, self.measured = moved, angles, measured
        vars(self).update(attributes)

    def move(self, angles, speed):
        super().move(angles, speed)
        if self.calls.count("move") == 3:
            self.moved(self)

    def angles(self):
        return self.changed(self, super().angles())

    def measure(self):
        return self.measured(self, super().measure())

    def shift(self, *by):
        """Stand elsewhere, by so many rad of all joints or of each."""
        self.stands = self.stands + by
        return self.stands
