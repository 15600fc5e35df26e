"""Damages of a robot: the whole of it shifted, links shortened, encoders shifted (section 7), and any combination."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
import pinocchio as pin
from scipy.spatial.transform import Rotation

from recalib.errors import InvalidSetting, UnknownName
from recalib.nominal.kinematics import Arm
from recalib.nominal.robots import Robot, link_end


@dataclass
class DamagedArm:
    """The arm that really moves: its kinematics, and what its encoders hide.

    Attributes:
        arm: the damaged kinematics.
        offsets: (6,) rad by which each joint stands beyond the angle that its encoder reports.
        deflections: functions of joint angles (n, 6) [rad] and of the torques (n, 6) [N m] that hold the arm against gravity
            there: what each adds to these angles, (n, 6) [rad].
    """

    arm: Arm
    offsets: np.ndarray
    deflections: list[Callable[[np.ndarray, np.ndarray], np.ndarray]] = field(default_factory=list)

    def forward(self, angles: np.ndarray) -> np.ndarray:
        """Poses (n, 4, 4) of the tool in the base frame [m] where the controller believes in joint angles (n, 6) [rad]."""
        return self.arm.forward(self.standing(angles))

    def standing(self, angles: np.ndarray) -> np.ndarray:
        """Joint angles (n, 6) [rad] at which the arm stands where the controller believes in `angles` (n, 6) [rad].

        Every deflection starts from the shifted angles, so that the order of the damages does not matter.
        """
        shifted = angles + self.offsets
        if not self.deflections:
            return shifted
        torques = self.arm.gravity_torque(shifted)
        return sum((deflection(shifted, torques) for deflection in self.deflections), start=shifted)


@dataclass(frozen=True)
class BaseShift:
    """The whole robot moved in the world, which the controller does not notice.

    Args:
        translation: (3,) m along the base's axes.
        rotation: (3,) rad, roll, pitch and yaw about the base's axes, R = Rz Ry Rx.
    """

    translation: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rotation: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def apply(self, robot: Robot, damaged: DamagedArm) -> None:
        shift = pin.SE3(
            Rotation.from_euler("xyz", self.rotation).as_matrix(), np.array(self.translation)
        )
        first = damaged.arm.model.jointPlacements[1]
        damaged.arm.model.jointPlacements[1] = shift * first


@dataclass(frozen=True)
class LinkShortening:
    """A link shortened along the straight line between its two joints (or its joint and the tool).

    Args:
        link: its name.
        length: m taken off.
    """

    link: str
    length: float

    def apply(self, robot: Robot, damaged: DamagedArm) -> None:
        if self.link not in robot.links:
            raise UnknownName(f"link of {robot.name}", self.link, robot.links)
        end = link_end(damaged.arm.model, damaged.arm.tool, robot.links[self.link])
        whole = np.linalg.norm(end)
        if not 0 <= self.length < whole:
            valid = f"from 0 to below {whole * 100:.2f} cm, its length"
            raise InvalidSetting(f"shorten of {self.link}", f"{self.length * 100:g} cm", valid)
        end *= 1 - self.length / whole


@dataclass(frozen=True)
class EncoderShift:
    """An encoder that reports an angle with a constant error.

    Args:
        joint: its name.
        angle: rad by which the joint stands beyond what its encoder reports.
    """

    joint: str
    angle: float

    def apply(self, robot: Robot, damaged: DamagedArm) -> None:
        if self.joint not in robot.joints:
            raise UnknownName(f"joint of {robot.name}", self.joint, robot.joints)
        damaged.offsets[robot.joints.index(self.joint)] += self.angle


class Damage(Protocol):
    """Anything that can happen to an arm."""

    def apply(self, robot: Robot, damaged: DamagedArm) -> None:
        """Do it to the damaged arm; `robot` is the nominal one, which knows the names and stays as it is."""
        ...


def apply(robot: Robot, damages: Iterable[Damage]) -> DamagedArm:
    """The arm of the nominal robot with the damages done to it, one after the other.

    Raises UnknownName (link, joint) and InvalidSetting (a link shortened by more than its length, or lengthened; what the
    damages of `recalib.damaged.nongeometric` refuse).
    """
    damaged = DamagedArm(Arm(pin.Model(robot.arm.model), robot.arm.tool), np.zeros(len(robot.home)))
    for damage in damages:
        damage.apply(robot, damaged)
    return damaged
