"""Damages that no change of the arm's geometry explains: eccentric gears, sag, backlash.

Each adds an error to a joint angle that depends on the arm's posture. They combine with one another
and with the damages of `recalib.damaged.damage` through its `apply`.
"""

from dataclasses import dataclass

import numpy as np

from recalib.damaged.damage import Damage, DamagedArm, joint_index
from recalib.damaged.imperfections import Joint
from recalib.files.bounded import Compliance, Direction, Turn
from recalib.nominal.kinematics import Arm

# N m. A smaller torque is a rounding error, as of a vertical axis: it does not move a joint to one
# side of its gap.
NO_LOAD = 1e-6


@dataclass(frozen=True)
class Deflection(Damage):
    """An error of a joint angle as a function of the angle and of the joint's torque."""

    joint: Joint

    def apply(self, arm: Arm, damaged: DamagedArm) -> None:
        damaged.deflections.append((joint_index(arm, self.joint), self.deflection))

    def deflection(self, angles: np.ndarray, torques: np.ndarray) -> np.ndarray:
        """Errors (n,) [rad] of the joint at its angles (n,) [rad] and torques (n,) [N m]."""
        raise NotImplementedError


@dataclass(frozen=True)
class EccentricGear(Deflection, words=("eccentricity",)):
    """An eccentric gear: the joint's error is eccentricity * sin(angle + phase)."""

    eccentricity: Turn
    """Amplitude of the error, a sine of the joint's angle."""
    phase: Direction = 0.0
    """Phase of this sine."""

    def deflection(self, angles: np.ndarray, torques: np.ndarray) -> np.ndarray:
        return self.eccentricity * np.sin(angles + self.phase)


@dataclass(frozen=True)
class Sag(Deflection, words=("compliance",)):
    """A compliant joint: gravity deflects it in proportion to its torque."""

    compliance: Compliance
    """Deflection for each unit of torque."""

    def deflection(self, angles: np.ndarray, torques: np.ndarray) -> np.ndarray:
        return -self.compliance * torques


@dataclass(frozen=True)
class Backlash(Deflection, words=("gap",)):
    """A gap in a gear: gravity displaces the joint by half the gap.

    The side depends on gravity, not on the last motion, so the achieved pose is a function of the
    command alone: the order and the number of measurements do not matter. A joint without load (a
    vertical axis) rests in the middle.
    """

    gap: Turn
    """Full width of the gap."""

    def deflection(self, angles: np.ndarray, torques: np.ndarray) -> np.ndarray:
        loaded = np.abs(torques) > NO_LOAD
        return np.where(loaded, -np.sign(torques) * self.gap / 2, 0.0)
