"""A nominal arm with everything about it that may be wrong as a parameter.

The parameters are small and zero for the nominal arm. In their order:

- twists (7, 6): xi_k = (v, w) [m, rad] moves what link k carries, in the frame of link k: the
  placement of joint k + 1 becomes exp(xi_k) M. Link 0 is the base, whose twist moves the whole arm;
  the last link carries the tool.
- joint terms (term, 6): coefficients of functions of the joint angles that add up to the joints'
  errors [rad]. The first term is constant, so its coefficients are the joint offsets [rad].

A joint offset is also a turn of its link's twist about the joint's axis, and neighbouring twists
share directions where joint axes are parallel or meet. No measurement tells such parameters apart:
the prior keeps them small.
"""

from collections.abc import Callable, Mapping
from functools import reduce
from operator import or_

import numpy as np
import pinocchio as pin

from recalib.nominal.kinematics import Arm, tool_frame
from recalib.nominal.robots import JOINTS

# Standard deviations of the parameters before anything is known: what wear and mounting plausibly
# do to an arm.
BASE = 0.05, np.radians(5)  # m, rad
LINK = 0.02, np.radians(0.5)

# By name, a function of the nominal arm and of joint angles (n, 6) [rad] with a value for each
# joint (n, 6), and the standard deviation of its coefficients before anything is known.
JointTerms = Mapping[str, tuple[Callable[[Arm, np.ndarray], np.ndarray], float]]


def _waves(order: int, amplitude: float) -> JointTerms:
    return {
        f"sine {order}": (lambda arm, angles: np.sin(order * angles), amplitude),
        f"cosine {order}": (lambda arm, angles: np.cos(order * angles), amplitude),
    }


# Geometry alone; with compliance [rad/Nm] and eccentric gears; with all that a gear adds to a turn.
OFFSETS: JointTerms = {"offset": (lambda arm, angles: np.ones_like(angles), np.radians(4))}
JOINT_ERRORS = OFFSETS | {"compliance": (Arm.gravity_torque, 1e-4)} | _waves(1, np.radians(0.5))
JOINT_WAVES = reduce(
    or_, (_waves(order, np.radians(0.05) / order) for order in range(2, 25)), JOINT_ERRORS
)

TWISTS = 6 * (JOINTS + 1)  # how many of the parameters are those of the twists


class ErrorModel:
    """The kinematics of an arm as a function of its parameters.

    Args:
        arm: the nominal kinematics.
        terms: the joint terms: `OFFSETS`, `JOINT_ERRORS` or `JOINT_WAVES`, each of which starts
            with the one before it.

    Attributes:
        names: of the joint terms.
        deviations: (P,) standard deviations of the parameters under the prior, whose mean is zero.
    """

    def __init__(self, arm: Arm, terms: JointTerms):
        self._nominal, self._terms, self.names = arm, terms, tuple(terms)
        twists = np.repeat([BASE] + [LINK] * JOINTS, 3, axis=1)
        scales = np.repeat([scale for _, scale in terms.values()], JOINTS)
        self.deviations = np.concatenate([twists.ravel(), scales])
        tool = arm.model.frames[tool_frame(arm.model, arm.tool)]
        self._placements = [*arm.model.jointPlacements[1:], tool.placement]

    def twists(self, parameters: np.ndarray) -> np.ndarray:
        """The twists (7, 6) [m, rad] in the parameters (P,)."""
        return parameters[:TWISTS].reshape(-1, 6)

    def coefficients(self, parameters: np.ndarray) -> dict[str, np.ndarray]:
        """The coefficients (6,) of each joint term in the parameters (P,)."""
        return dict(zip(self._terms, parameters[TWISTS:].reshape(-1, JOINTS), strict=True))

    def arm(self, parameters: np.ndarray) -> Arm:
        """The arm with the twists of the parameters (P,) done to it."""
        model = pin.Model(self._nominal.model)
        *joints, tool = (
            pin.exp6(pin.Motion(twist)) * nominal
            for twist, nominal in zip(self.twists(parameters), self._placements, strict=True)
        )
        for joint, placement in enumerate(joints, start=1):
            model.jointPlacements[joint] = placement
        model.frames[tool_frame(model, self._nominal.tool)].placement = tool
        return Arm(model, self._nominal.tool)

    def terms(self, angles: np.ndarray) -> np.ndarray:
        """The joint terms (n, term, 6) at angles (n, 6) [rad] in which the controller believes."""
        return np.stack([term(self._nominal, angles) for term, _ in self._terms.values()], axis=1)

    def standing(self, parameters: np.ndarray, angles: np.ndarray, terms: np.ndarray) -> np.ndarray:
        """Where the joints stand (n, 6) [rad].

        Args:
            parameters: (P,) of the model.
            angles: (n, 6) rad in which the controller believes.
            terms: (n, term, 6) theirs.
        """
        return angles + np.einsum("ntj,tj->nj", terms, parameters[TWISTS:].reshape(-1, JOINTS))

    def predict(self, parameters: np.ndarray, angles: np.ndarray) -> np.ndarray:
        """Poses (n, 4, 4) of the tool in the base frame [m].

        Args:
            parameters: (P,) of the model.
            angles: (n, 6) rad in which the controller believes.
        """
        return self.arm(parameters).forward(self.standing(parameters, angles, self.terms(angles)))

    def linearise(
        self, parameters: np.ndarray, angles: np.ndarray, terms: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Poses (n, 4, 4) as `predict`, and their Jacobians (n, 6, P) by the parameters.

        A Jacobian maps a change of the parameters to the tool's translation [m] and turn [rad]
        along the base's axes. The terms are those of the angles; they depend on no parameter, so
        that one evaluation serves all linearisations.
        """
        standing = self.standing(parameters, angles, terms)
        poses, joints, placements = self.arm(parameters).forward_and_all_jacobians(standing)
        # exp(xi + dxi) M = exp(xi) M exp(inv(M) J dxi): it moves what the twist places
        motions = [
            nominal.inverse().action @ pin.Jexp6(pin.Motion(twist))
            for nominal, twist in zip(self._placements, self.twists(parameters), strict=True)
        ]
        jacobians = np.empty((len(angles), 6, len(parameters)))
        by_link = placements.reshape(-1, JOINTS + 1, 6).swapaxes(0, 1) @ np.stack(motions)
        jacobians[..., :TWISTS] = by_link.swapaxes(0, 1).reshape(len(angles), 6, TWISTS)
        jacobians[..., TWISTS:] = (joints[:, :, None] * terms[:, None]).reshape(len(angles), 6, -1)
        return poses, jacobians
