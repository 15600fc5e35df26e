"""Damages of a robot, alone or combined: moved as a whole, links shortened, encoders shifted.

These are the damages of section 7; `recalib.damaged.nongeometric` has more.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Literal, Self, get_args

import numpy as np
import pinocchio as pin
from scipy.spatial.transform import Rotation

from recalib.arrays import array_of
from recalib.damaged.imperfections import Imperfection, Joint, Link
from recalib.errors import InvalidSetting, check_kind, check_name
from recalib.files.bounded import Amount, Length, SignedTurn
from recalib.nominal.chain import Chain
from recalib.nominal.kinematics import Arm
from recalib.nominal.robots import Robot, link_end

Along = Literal["line", "axis"]  # in which a link is shortened


@dataclass
class DamagedArm:
    """The real arm: its kinematics and its encoder offsets.

    All damages are done before it is asked where it goes: see `apply`.

    Attributes:
        arm: the damaged kinematics.
        offsets: (joint,) rad by which each joint stands beyond the angle that its encoder reports.
        deflections: of joints by their numbers, each a function of the joint's angles (n,) [rad]
            and of the torques (n,) [N m] that hold it against gravity: what it adds to the angles.
    """

    arm: Arm
    offsets: np.ndarray
    deflections: list[tuple[int, Callable[[np.ndarray, np.ndarray], np.ndarray]]] = field(
        default_factory=list
    )

    def forward(self, angles: np.ndarray) -> np.ndarray:
        """Poses (n, 4, 4) of the tool in the base frame [m].

        A controller assumes angles (n, joint) [rad]. Raises InvalidSetting: another shape.
        """
        joints = array_of("angles", angles, ("n", len(self.offsets)))
        return self.chain.forward(self._deflected(joints)[None])[0]

    @cached_property
    def chain(self) -> Chain:
        """Its kinematics at angles that encoders report if nothing gives way.

        It is fixed at its first use, so all damages must be applied before.
        """
        return Chain.of(self.arm, self.offsets)

    def standing(self, angles: np.ndarray) -> np.ndarray:
        """True joint angles (n, joint) [rad] at angles (n, joint) [rad] that a controller assumes.

        Every deflection starts from the shifted angles, so that the order of the damages does not
        matter.
        """
        return self._deflected(angles) + self.offsets

    def _deflected(self, angles: np.ndarray) -> np.ndarray:
        if not self.deflections:
            return angles
        shifted, deflected = angles + self.offsets, angles.astype(float)
        torques = self.arm.gravity_torque(shifted)
        for joint, deflection in self.deflections:
            deflected[:, joint] += deflection(shifted[:, joint], torques[:, joint])
        return deflected


@dataclass(frozen=True)
class Damage(Imperfection):
    """Anything that can happen to an arm. A new kind is a class in a module of this package."""

    def apply(self, arm: Arm, damaged: DamagedArm) -> None:
        """Do it to the damaged arm; `arm` is the nominal one, which stays as it is.

        Raises UnknownName (link, joint) and InvalidSetting (more than the arm can lose).
        """
        raise NotImplementedError

    def scaled(self, factor: float) -> Self:
        """This damage, `factor` times as large."""
        grown = {}
        for name in self.amounts():
            value = getattr(self, name)
            several = isinstance(value, tuple)
            grown[name] = tuple(x * factor for x in value) if several else value * factor
        return replace(self, **grown)


@dataclass(frozen=True)
class BaseShift(Damage, words=("translate", "rotate")):
    """A displacement of the whole robot, unknown to the controller."""

    translate: tuple[Length, Length, Length] = (0.0, 0.0, 0.0)
    """Of the whole robot along the base's x, y and z."""
    rotate: tuple[SignedTurn, SignedTurn, SignedTurn] = (0.0, 0.0, 0.0)
    """Of the whole robot: roll, pitch and yaw about the base's axes, R = Rz Ry Rx."""

    def __post_init__(self) -> None:
        super().__post_init__()
        for name in ("translate", "rotate"):
            array_of(f"BaseShift.{name}", getattr(self, name), (3,))

    def apply(self, arm: Arm, damaged: DamagedArm) -> None:
        turn = Rotation.from_euler("xyz", self.rotate).as_matrix()
        placements = damaged.arm.model.jointPlacements
        placements[1] = pin.SE3(turn, np.array(self.translate)) * placements[1]


@dataclass(frozen=True)
class LinkShortening(Damage, words=("shorten",)):
    """A link shortened between its joints (the last: joint and tool)."""

    link: Link
    shorten: Amount
    """Length taken off."""
    along: Along = "line"
    """The straight line between its joints, or the axis of its frame along which it is longest."""

    def __post_init__(self) -> None:
        super().__post_init__()
        check_name("direction in which a link is shortened", self.along, get_args(Along))

    def apply(self, arm: Arm, damaged: DamagedArm) -> None:
        end = end_of(arm, self.link, damaged).translation
        longest = np.abs(end).argmax()
        part = end if self.along == "line" else end[longest : longest + 1]
        whole = np.linalg.norm(part)
        if self.shorten >= whole:
            valid = f"from 0 to below {whole * 100:.2f} cm, its length"
            raise InvalidSetting(f"shorten of {self.link}", f"{self.shorten * 100:g} cm", valid)
        part *= 1 - self.shorten / whole


@dataclass(frozen=True)
class EncoderShift(Damage, words=("encoder", "shift")):
    """An encoder that reports an angle with a constant error."""

    encoder: Joint
    shift: SignedTurn
    """Angle by which the joint stands beyond what its encoder reports."""

    def apply(self, arm: Arm, damaged: DamagedArm) -> None:
        damaged.offsets[joint_index(arm, self.encoder)] += self.shift


def end_of(arm: Arm, link: str, damaged: DamagedArm) -> pin.SE3:
    """Where a link ends in the frame of the joint that moves it; changing it changes the arm.

    Raises UnknownName.
    """
    check_name("link", link, arm.links)
    return link_end(damaged.arm.model, damaged.arm.tool, arm.links[link])


def joint_index(arm: Arm, joint: str) -> int:
    """Which joint of the arm has this name. Raises UnknownName: none, or one that slides."""
    turning = [name for name, slides in zip(arm.joints, arm.slides, strict=True) if not slides]
    check_name("turning joint", joint, turning)
    return arm.joints.index(joint)


def apply(nominal: Robot | Arm, damages: Iterable[Damage]) -> DamagedArm:
    """The nominal arm with damages applied in order.

    Raises InvalidSetting: something else than an arm or damages; and what these raise: see
    `Damage.apply`.
    """
    check_kind("nominal", nominal, Robot, Arm)
    check_kind("damages", damages, Iterable)
    arm = nominal.arm if isinstance(nominal, Robot) else nominal
    damaged = DamagedArm(arm.copy(), np.zeros(len(arm.joints)))
    for damage in damages:
        check_kind("damage", damage, Damage)
        damage.apply(arm, damaged)
    return damaged
