"""Damages that no change of the arm's geometry explains: eccentric gears, sag, backlash.

Each makes a joint stand off by an angle that depends on the arm's posture. They combine with one
another and with the damages of `recalib.damaged.damage` through its `apply`.
"""

from dataclasses import dataclass

import numpy as np

from recalib.damaged.damage import Damage, DamagedArm, joint_index
from recalib.damaged.imperfections import Joint
from recalib.files.bounded import Compliance, Direction, Turn
from recalib.nominal.kinematics import Arm

# N m below which gravity does not decide to which side of its gap a joint falls: rounding of a
# vertical axis, no load.
NO_LOAD = 1e-6


@dataclass(frozen=True)
class Deflection(Damage):
    """A joint that stands off by an angle of its own angle and of the torque that it holds."""

    joint: Joint

    def apply(self, arm: Arm, damaged: DamagedArm) -> None:
        damaged.deflections.append((joint_index(arm, self.joint), self.deflection))

    def deflection(self, angles: np.ndarray, torques: np.ndarray) -> np.ndarray:
        """By how much it stands off, (n,) rad, at its angles (n,) [rad] and torques (n,) [N m]."""
        raise NotImplementedError


@dataclass(frozen=True)
class EccentricGear(Deflection, words=("eccentricity",)):
    """An eccentric gear: the joint's error is eccentricity * sin(angle + phase)."""

    eccentricity: Turn
    """Amplitude of its error, which goes as the sine of its angle."""
    phase: Direction = 0.0
    """Of that sine."""

    def deflection(self, angles: np.ndarray, torques: np.ndarray) -> np.ndarray:
        return self.eccentricity * np.sin(angles + self.phase)


@dataclass(frozen=True)
class Sag(Deflection, words=("compliance",)):
    """A compliant joint: it yields to gravity in proportion to its torque."""

    compliance: Compliance
    """By how much it gives way to gravity."""

    def deflection(self, angles: np.ndarray, torques: np.ndarray) -> np.ndarray:
        return -self.compliance * torques


@dataclass(frozen=True)
class Backlash(Deflection, words=("gap",)):
    """A gap in a gear: gravity displaces the joint by half the gap.

    Gravity decides rather than the last motion, so that the achieved pose is a function of the
    command alone: measuring an arm in any order, or in between, changes nothing. A joint without
    load (a vertical axis) rests in the middle.
    """

    gap: Turn
    """From one side of the gear's gap to the other."""

    def deflection(self, angles: np.ndarray, torques: np.ndarray) -> np.ndarray:
        loaded = np.abs(torques) > NO_LOAD
        return np.where(loaded, -np.sign(torques) * self.gap / 2, 0.0)
