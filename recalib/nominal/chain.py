"""Serial arms as arrays, for many postures at once.

The "angle" of a sliding joint is a length [m]. The placements of joints and tool come from
Pinocchio, which is the reference in tests.
"""

from collections.abc import Sequence
from typing import Self

import numpy as np
import pinocchio as pin

from recalib.arrays import array_of, numbers
from recalib.errors import InvalidSetting, check_kind
from recalib.nominal import kernels
from recalib.nominal.kinematics import Arm

TOLERANCE = kernels.TOLERANCE
Z = np.array([0.0, 0.0, 1.0])


class Chain(kernels.Arms):
    """Serial arms of n joints, side by side: see `recalib.nominal.kernels.Arms`."""

    __slots__ = ()

    @classmethod
    def of(cls, arm: Arm, offsets: np.ndarray | None = None) -> Self:
        """A single arm; `offsets` (n,) [rad, m] are added to its joint angles.

        The chain is a copy: later changes of the arm do not affect it. Raises InvalidSetting for
        anything else than an arm, and for offsets of other joints.
        """
        check_kind("arm", arm, Arm)
        if offsets is not None:
            offsets = array_of("offsets", offsets, (len(arm.joints),))
        joints, before, placements = [*arm.model.jointPlacements][1:], pin.SE3.Identity(), []
        for joint, placement in enumerate(joints):
            # M(q + offset) = R Mz(offset) Mz(q) inv(R); R rotates z to the joint's axis
            along_z = pin.SE3(pin.Quaternion.FromTwoVectors(Z, arm.axes[joint]), np.zeros(3))
            offset = 0.0 if offsets is None else offsets[joint]
            moved = pin.SE3(pin.AngleAxis(offset, Z).matrix(), np.zeros(3))
            if arm.slides[joint]:
                moved = pin.SE3(np.eye(3), offset * Z)
            placements.append(before * placement * along_z * moved)
            before = along_z.inverse()
        placements.append(before * arm.end.placement)
        matrices = [placement.homogeneous[:3] for placement in placements]
        return cls(np.array([matrices]), arm.slides[None])

    @classmethod
    def side_by_side(cls, chains: Sequence[Self]) -> Self:
        """All arms of several chains, which must have the same number of joints.

        Raises InvalidSetting if they have not, or are not chains.
        """
        for chain in chains:
            check_kind("chain", chain, Chain)
        if len({chain.slides.shape[1] for chain in chains}) != 1:
            counts = [chain.slides.shape[1] for chain in chains]
            raise InvalidSetting("chains", f"of {counts} joints", "equal numbers of joints")
        return cls(*map(np.concatenate, zip(*chains, strict=True)))

    def forward(self, angles: np.ndarray) -> np.ndarray:
        """Poses (arm, posture, 4, 4) of the tools [m] at joint angles (arm, posture, n) [rad].

        Raises InvalidSetting for another number of arms or joints.
        """
        return kernels.forward(tuple(self), self._checked(angles, len(self.slides)))

    def solve(self, poses: np.ndarray, start: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Joint angles (posture, n) [rad] that take the tool of the first arm to poses.

        Newton's method solves each pose independently. With more than six joints, each step is the
        shortest; with fewer, it minimises the residual.

        Args:
            poses: (posture, 4, 4) m.
            start: (posture, n) rad, initial estimates.

        Returns the angles and their errors (posture,): the largest component of the residual, in m
        and rad. If an error exceeds TOLERANCE, the pose was not reached. It is infinite if the pose
        or the initial estimate contains nan.

        Raises InvalidSetting for another number of joints, or another number of initial estimates.
        """
        start, poses = self._checked(start), numbers("poses", poses)
        if poses.shape != (len(start), 4, 4):
            valid = f"an array ({len(start)}, 4, 4)"
            raise InvalidSetting("poses", f"of shape {poses.shape}", valid)
        return kernels.solve(tuple(self), poses, start)

    def _checked(self, angles: np.ndarray, *arms: int) -> np.ndarray:
        """Angles (*arms, posture, n). Raises InvalidSetting otherwise: compiled loops cannot."""
        angles = numbers("joint angles", angles)
        expected = *arms, np.atleast_2d(angles).shape[-2], self.slides.shape[1]
        if angles.shape != expected:
            found, valid = f"of shape {angles.shape}", f"an array {expected}"
            raise InvalidSetting("joint angles", found, valid)
        return angles
