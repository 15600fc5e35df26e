"""The damages of section 7, alone or combined: displaced base, short links, shifted encoders.

`recalib.damaged.nongeometric` and `recalib.damaged.bending` have more.
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

Along = Literal["line", "axis"]  # the direction in which a link is shortened


@dataclass
class DamagedArm:
    """The real arm: its kinematics and its encoder offsets.

    Apply all damages before the first call of `forward`: see `apply`.

    Attributes:
        arm: the damaged kinematics.
        offsets: (joint,) rad, true joint angle minus the angle that the encoder reports.
        deflections: pairs of a joint's index and a function, which returns the angles (n,) [rad] to
            add, given the joint's angles (n,) [rad] and its torques (n,) [N m] against gravity.
    """

    arm: Arm
    offsets: np.ndarray
    deflections: list[tuple[int, Callable[[np.ndarray, np.ndarray], np.ndarray]]] = field(
        default_factory=list
    )

    def forward(self, angles: np.ndarray) -> np.ndarray:
        """Poses (n, 4, 4) of the tool in the base frame [m].

        `angles` (n, joint) [rad] are the controller's. Raises InvalidSetting for another shape.
        """
        joints = array_of("angles", angles, ("n", len(self.offsets)))
        return self.chain.forward(self._deflected(joints)[None])[0]

    @cached_property
    def chain(self) -> Chain:
        """The damaged kinematics as a function of encoder angles, without deflections.

        It is cached at its first use, so all damages must be applied before.
        """
        return Chain.of(self.arm, self.offsets)

    def standing(self, angles: np.ndarray) -> np.ndarray:
        """True joint angles (n, joint) [rad], given the controller's angles (n, joint) [rad].

        Every deflection is computed at the shifted angles, so the order of the damages does not
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
    """Base class of damages. To add a kind, define a class in a module of this package."""

    def apply(self, arm: Arm, damaged: DamagedArm) -> None:
        """Apply this damage to `damaged`, in place; `arm` is the nominal arm and does not change.

        Raises UnknownName (link, joint) and InvalidSetting (a damage larger than the arm allows).
        """
        raise NotImplementedError

    def scaled(self, factor: float) -> Self:
        """This damage, `factor` times as large."""
        scaled = {}
        for name in self.amounts():
            value = getattr(self, name)
            several = isinstance(value, tuple)
            scaled[name] = tuple(x * factor for x in value) if several else value * factor
        return replace(self, **scaled)


@dataclass(frozen=True)
class BaseShift(Damage, words=("translate", "rotate")):
    """A displacement of the whole robot that the controller does not know."""

    translate: tuple[Length, Length, Length] = (0.0, 0.0, 0.0)
    """Translation of the whole robot along the base's x, y and z."""
    rotate: tuple[SignedTurn, SignedTurn, SignedTurn] = (0.0, 0.0, 0.0)
    """Rotation of the whole robot: roll, pitch and yaw about the base's axes, R = Rz Ry Rx."""

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
    """A link shortened between its joints; the last link, between its joint and the tool."""

    link: Link
    shorten: Amount
    """Length taken off."""
    along: Along = "line"
    """Along the straight line between the joints, or the frame axis along which it is longest."""

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
    """A constant error of the angle that an encoder reports."""

    encoder: Joint
    shift: SignedTurn
    """True joint angle minus the reported angle."""

    def apply(self, arm: Arm, damaged: DamagedArm) -> None:
        damaged.offsets[joint_index(arm, self.encoder)] += self.shift


def end_of(arm: Arm, link: str, damaged: DamagedArm) -> pin.SE3:
    """The end of a link in the frame of the joint that moves it. Changing it changes the arm.

    Raises UnknownName.
    """
    check_name("link", link, arm.links)
    return link_end(damaged.arm, arm.links[link])


def joint_index(arm: Arm, joint: str) -> int:
    """Index of a joint, by its name. Raises UnknownName if no turning joint has this name."""
    turning = [name for name, slides in zip(arm.joints, arm.slides, strict=True) if not slides]
    check_name("turning joint", joint, turning)
    return arm.joints.index(joint)


def apply(nominal: Robot | Arm, damages: Iterable[Damage]) -> DamagedArm:
    """The nominal arm with damages applied in order.

    Raises InvalidSetting for arguments of other types, and the exceptions of `Damage.apply`.
    """
    check_kind("nominal", nominal, Robot, Arm)
    check_kind("damages", damages, Iterable)
    arm = nominal.arm if isinstance(nominal, Robot) else nominal
    damaged = DamagedArm(arm.copy(), np.zeros(len(arm.joints)))
    for damage in damages:
        check_kind("damage", damage, Damage)
        damage.apply(arm, damaged)
    return damaged
