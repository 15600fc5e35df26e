"""Damages that no change of the arm's geometry explains: eccentric gears, sag under gravity, backlash.

Each makes a joint stand off by an angle that depends on the arm's posture. They combine with one another and with the
damages of `recalib.damaged.damage` through its `apply`.
"""

import math
from dataclasses import dataclass
from functools import partial

import numpy as np

from recalib.damaged.damage import DamagedArm
from recalib.errors import InvalidSetting, UnknownName
from recalib.nominal.robots import Robot

# N m below which gravity does not decide to which side of its gap a joint falls: rounding of a vertical axis, no load.
NO_LOAD = 1e-6


@dataclass(frozen=True)
class EccentricGear:
    """A gear out of centre: its joint is wrong by amplitude * sin(angle + phase).

    Args:
        joint: its name.
        amplitude: rad, not negative.
        phase: rad.
    """

    joint: str
    amplitude: float
    phase: float = 0.0

    def apply(self, robot: Robot, damaged: DamagedArm) -> None:
        _check_size("amplitude of an eccentric gear", self.amplitude, "rad")
        damaged.deflections.append(partial(self._deflection, _index(robot, self.joint)))

    def _deflection(self, joint: int, angles: np.ndarray, torques: np.ndarray) -> np.ndarray:
        return _only(joint, self.amplitude * np.sin(angles[:, joint] + self.phase))


@dataclass(frozen=True)
class Sag:
    """A joint that gives way to gravity in proportion to the torque that it holds.

    Args:
        joint: its name.
        compliance: rad per N m, not negative.
    """

    joint: str
    compliance: float

    def apply(self, robot: Robot, damaged: DamagedArm) -> None:
        _check_size("compliance of a joint", self.compliance, "rad/Nm")
        damaged.deflections.append(partial(self._deflection, _index(robot, self.joint)))

    def _deflection(self, joint: int, angles: np.ndarray, torques: np.ndarray) -> np.ndarray:
        return _only(joint, -self.compliance * torques[:, joint])


@dataclass(frozen=True)
class Backlash:
    """A gap in a gear: the joint lies on the side to which gravity pushes it, half the gap from where it should stand.

    Gravity decides rather than the last motion, so that the achieved pose is a function of the command alone: measuring an
    arm in any order, or in between, changes nothing. A joint without load (a vertical axis) rests in the middle.

    Args:
        joint: its name.
        gap: rad from one side to the other, not negative.
    """

    joint: str
    gap: float

    def apply(self, robot: Robot, damaged: DamagedArm) -> None:
        _check_size("gap of a gear", self.gap, "rad")
        damaged.deflections.append(partial(self._deflection, _index(robot, self.joint)))

    def _deflection(self, joint: int, angles: np.ndarray, torques: np.ndarray) -> np.ndarray:
        loaded = np.abs(torques[:, joint]) > NO_LOAD
        return _only(joint, np.where(loaded, -np.sign(torques[:, joint]) * self.gap / 2, 0.0))


def _index(robot: Robot, joint: str) -> int:
    if joint not in robot.joints:
        raise UnknownName(f"joint of {robot.name}", joint, robot.joints)
    return robot.joints.index(joint)


def _check_size(what: str, size: float, unit: str) -> None:
    if not 0 <= size < math.inf:
        raise InvalidSetting(what, size, f"a finite number of {unit} from 0 on")


def _only(joint: int, deflection: np.ndarray) -> np.ndarray:
    deflections = np.zeros((len(deflection), 6))
    deflections[:, joint] = deflection
    return deflections
