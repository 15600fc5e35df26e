"""An arm with errors: a nominal arm whose possible errors are parameters.

The parameters are small, and zero for the nominal arm. In this order:

- twists (joints + targets, 6): xi_k = (v, w) [m, rad] moves everything that link k carries, in the
  frame of link k: the placement of joint k + 1 becomes exp(xi_k) M. Link 0 is the base, whose twist
  moves the whole arm; the last link carries the targets, each with a twist of its own. If frames
  are known, the tool is the only target. Further instruments have further twists of the base.
- centres (socket, 3): displacements [m] of the sockets from their initial estimate.
- optics (o,): of the measuring cameras; see `recalib.identification.model.optics`.
- joint terms (term, joints): coefficients of functions of the joint coordinates that add up to the
  joints' errors [rad, m]. The first term is constant, so its coefficients are the joint offsets.

A joint offset is also a rotation of its link's twist about the joint's axis, and neighbouring
twists share directions where joint axes are parallel or meet. No measurement distinguishes such
parameters: the prior keeps them small.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import cached_property, reduce
from operator import or_
from typing import Any

import numpy as np
import pinocchio as pin

from recalib.identification.model.frames import HELD, UNKNOWN, Frames
from recalib.nominal.kinematics import Arm

# By name: a function of the nominal arm and of joint coordinates (n, joints) [rad, m] that returns
# a value for each joint (n, joints), and the prior standard deviation of its coefficients, one for
# all joints or one for each.
JointTerms = dict[str, tuple[Callable[[Arm, np.ndarray], np.ndarray], float | np.ndarray]]


def held(terms: JointTerms, joints: np.ndarray) -> JointTerms:
    """The same terms, with the errors of some joints, a mask (joints,), held at zero."""
    return {
        name: (function, np.where(joints, HELD, scale)) for name, (function, scale) in terms.items()
    }


def _waves(order: int, amplitude: float) -> JointTerms:
    return {
        f"sine {order}": (lambda arm, angles: np.sin(order * angles), amplitude),
        f"cosine {order}": (lambda arm, angles: np.cos(order * angles), amplitude),
    }


# The nominal arm; geometry alone; also compliance [rad/Nm] and eccentric gears; also the higher
# harmonics of a gear's transmission error.
NO_ERRORS: JointTerms = {}
OFFSETS: JointTerms = {"offset": (lambda arm, angles: np.ones_like(angles), np.radians(4))}
JOINT_ERRORS = OFFSETS | {"compliance": (Arm.gravity_torque, 1e-4)} | _waves(1, np.radians(0.5))
JOINT_WAVES = reduce(
    or_, (_waves(order, np.radians(0.05) / order) for order in range(2, 25)), JOINT_ERRORS
)


class ErrorModel:
    """The kinematics of an arm as a function of its parameters.

    Only revolute joints have waves and compliance. If the masses of the links are unknown, gravity
    torques are, too, and there is no compliance. These coefficients are held at zero.

    Args:
        arm: the nominal kinematics.
        terms: the joint terms: `OFFSETS`, `JOINT_ERRORS` or `JOINT_WAVES`, each of which starts
            with the one before it; or `NO_ERRORS`, which holds all but unknown frames at nominal.
        frames: the frames at both ends of the arm; default: the arm's own base and tool.

    Attributes:
        nominal, frames: the arguments.
        names: the names of the joint terms.
        deviations: (P,) standard deviations of the parameters under the prior, whose mean is zero.
        free: (P,) whether a parameter belongs to unknown frames or optics and need not be small.
    """

    def __init__(self, arm: Arm, terms: JointTerms, frames: Frames | None = None):
        self.nominal, self.frames = arm, frames or Frames()
        self._terms, self.names = terms, tuple(terms)
        targets, sockets = self.frames.targets, self.frames.sockets
        self._joints = arm.model.nv
        ends = self._joints + len(targets)  # where the twists of further instruments begin
        self._twists = 6 * (ends + len(self.frames.further))  # the number of twist parameters
        self._optics = self._twists + sockets.size
        self._geometry = self._optics + len(self.frames.optics_deviations)
        links = [self.frames.link_deviations] * (self._joints - 1)
        links += [self.frames.target_deviations] * len(targets)
        links += [self.frames.base_deviations] * len(self.frames.further)
        twists = np.repeat([self.frames.base_deviations, *links], 3, axis=1).ravel()
        self.deviations = np.concatenate(
            [
                twists,
                np.full(sockets.size, UNKNOWN[0]),
                self.frames.optics_deviations,
                self._coefficient_deviations().ravel(),
            ]
        )
        self.free = np.zeros(len(self.deviations), dtype=bool)
        self.free[:6] = self.frames.base_unknown
        self.free[6 * self._joints : 6 * ends] = self.frames.targets_unknown
        self.free[6 * ends : self._geometry] = True
        if not terms:
            self.deviations[~self.free] = HELD
        self._base = pin.SE3(self.frames.base)
        self._tool = arm.end.placement
        first, *others = arm.model.jointPlacements[1:]
        self._placements = [self._base * first, *others]
        self._placements += [self._tool * pin.SE3(target) for target in targets]
        self._placements += [pin.SE3(base) * first for base in self.frames.further]
        self._moving = arm.copy()  # to be moved and used at once: an arm is slower to make
        self._into = [placement.inverse().action for placement in self._placements]
        self._ends = [  # the numbers of the twists at both ends of each sight
            (ends + instrument - 1 if instrument else 0, self._joints + target)
            for instrument, target in self.frames.sights.tolist()
        ]

    def _coefficient_deviations(self) -> np.ndarray:
        """Standard deviations (term, joints) of the joint terms' coefficients."""
        if not self._terms:
            return np.empty((0, self._joints))
        scales = [np.broadcast_to(scale, self._joints) for _, scale in self._terms.values()]
        deviations = np.array(scales)
        slides = self.nominal.slides
        deviations[:, slides] = HELD
        deviations[0] = self.frames.offset_deviation or deviations[0]
        deviations[0, slides] = self.frames.link_deviations[0]  # a length instead of an angle
        if self.nominal.massless and "compliance" in self.names:
            deviations[self.names.index("compliance")] = HELD
        return np.where(np.array(scales) > HELD, deviations, HELD)

    def twists(self, parameters: np.ndarray) -> np.ndarray:
        """The twists (joints + targets + further instruments, 6) [m, rad] in parameters (P,)."""
        return parameters[: self._twists].reshape(-1, 6)

    def shifts(self, parameters: np.ndarray) -> np.ndarray:
        """How far (joints + targets + further instruments,) [m] the twists move the frames."""
        pairs = zip(self._placed(parameters), self._placements, strict=True)
        return np.array([np.linalg.norm(a.translation - b.translation) for a, b in pairs])

    def sockets(self, parameters: np.ndarray) -> np.ndarray:
        """The sockets' centres (socket, 3) [m] in the frame of the instrument."""
        return self.frames.sockets + parameters[self.socket_columns].reshape(-1, 3)

    @cached_property
    def stated(self) -> np.ndarray:
        """The stated information (P, P) on frames, of parameters over their deviations."""
        frames, information = self.frames, np.zeros((len(self.deviations),) * 2)
        into_base, into_tool = frames.base[:3, :3].T, self._tool.rotation.T
        ends = [(0, into_base, np.zeros(3), frames.base_prior)]
        ends += [
            (self._joints + number, into_tool, (self._tool * pin.SE3(target)).translation, prior)
            for prior in [frames.target_prior]
            for number, target in enumerate(frames.targets)
        ]
        for number, turn, point, prior in ends:
            if len(prior):  # slopes of the end's motion by the twist, over their deviations
                columns, moves = slice(6 * number, 6 * number + 6), np.kron(np.eye(2), turn)
                moves[:3, 3:] = -turn @ pin.skew(point)
                slopes = moves * self.deviations[columns] / prior[:, None]
                information[columns, columns] = slopes.T @ slopes
        return information

    @property
    def size(self) -> int:
        """The number of parameters that are not held."""
        return int(np.sum(self.deviations > HELD))

    @property
    def socket_columns(self) -> slice:
        """The indices of the sockets' centres among the parameters."""
        return slice(self._twists, self._optics)

    @property
    def optics_columns(self) -> slice:
        """The indices of the cameras' optics among the parameters."""
        return slice(self._optics, self._geometry)

    @property
    def offset_columns(self) -> slice:
        """The indices of the joint offsets among the parameters."""
        return slice(self._geometry, self._geometry + self._joints)

    def coefficients(self, parameters: np.ndarray) -> dict[str, np.ndarray]:
        """The coefficients (joints,) of each joint term in the parameters (P,)."""
        by_term = parameters[self._geometry :].reshape(-1, self._joints)
        return dict(zip(self._terms, by_term, strict=True))

    def _placed(self, parameters: np.ndarray) -> list[pin.SE3]:
        """The placements of joints and targets, moved by the twists in the parameters."""
        return [
            pin.exp6(pin.Motion(twist)) * nominal
            for twist, nominal in zip(self.twists(parameters), self._placements, strict=True)
        ]

    @staticmethod
    def _with(arm: Arm, joints: list[pin.SE3], tool: pin.SE3) -> Arm:
        for joint, placement in enumerate(joints, start=1):
            arm.model.jointPlacements[joint] = placement
        arm.end.placement = tool
        return arm

    def arm(self, parameters: np.ndarray, sight: int = 0) -> Arm:
        """The arm from the instrument to the target of a sight, moved by the parameters' twists."""
        return self._to(sight, self._placed(parameters), self.nominal.copy())

    def _to(self, sight: int, placed: list[pin.SE3], arm: Arm) -> Arm:
        start, end = self._ends[sight]
        return self._with(arm, [placed[start], *placed[1 : self._joints]], placed[end])

    def own_arm(self, parameters: np.ndarray) -> Arm:
        """The same arm from its own base to its own tool, without instrument and target."""
        (first, *others), frames = self._placed(parameters), self.found(parameters)
        first = pin.SE3(frames.base).inverse() * first
        tool = others[self._joints - 1] * pin.SE3(frames.targets[0]).inverse()
        return self._with(self.nominal.copy(), [first, *others[: self._joints - 1]], tool)

    def found(self, parameters: np.ndarray) -> Frames:
        """The frames at both ends, moved by the parameters."""
        base, *_ = twists = [pin.exp6(pin.Motion(twist)) for twist in self.twists(parameters)]
        frames, found = self.frames, dict[str, Any](sockets=self.sockets(parameters))
        if frames.base_unknown:
            found["base"] = (base * self._base).homogeneous
        if len(frames.further):
            moved = zip(twists[-len(frames.further) :], frames.further, strict=True)
            found["further"] = np.array([(by * pin.SE3(pose)).homogeneous for by, pose in moved])
        if frames.targets_unknown:
            at_targets = slice(self._joints, self._joints + len(frames.targets))
            ends = zip(twists[at_targets], self._placements[at_targets], strict=True)
            targets = [self._tool.inverse() * twist * placement for twist, placement in ends]
            found["targets"] = np.array([pose.homogeneous for pose in targets])
        return replace(frames, **found)

    def terms(self, joints: np.ndarray) -> np.ndarray:
        """The joint terms (n, term, joints) at joint coordinates (n, joints) [rad, m]."""
        terms = np.empty((len(joints), len(self._terms), self._joints))
        for index, (term, _) in enumerate(self._terms.values()):
            terms[:, index] = term(self.nominal, joints)
        return terms

    def standing(
        self, parameters: np.ndarray, joints: np.ndarray, terms: np.ndarray | None = None
    ) -> np.ndarray:
        """The actual joint coordinates (n, joints) [rad, m]: the reported ones plus errors."""
        terms = self.terms(joints) if terms is None else terms
        coefficients = parameters[self._geometry :].reshape(-1, self._joints)
        return joints + np.einsum("ntj,tj->nj", terms, coefficients)

    def predict(
        self, parameters: np.ndarray, joints: np.ndarray, targets: np.ndarray | None = None
    ) -> np.ndarray:
        """Poses (n, 4, 4) [m] of targets in the frame of the instrument, for parameters (P,).

        The controller reports joints (n, joints) [rad, m]. `targets` (n,) are the numbers of the
        sights; default: the first.
        """
        standing, placed = self.standing(parameters, joints), self._placed(parameters)
        poses = np.empty((len(joints), 4, 4))
        for sight, rows in by_sight(targets, len(joints)):
            poses[rows] = self._to(sight, placed, self._moving).forward(standing[rows])
        return poses

    def linearise(
        self,
        parameters: np.ndarray,
        joints: np.ndarray,
        targets: np.ndarray | None = None,
        terms: np.ndarray | None = None,
    ) -> tuple[np.ndarray, np.ndarray]:
        """Poses (n, 4, 4) as in `predict`, and their Jacobians (n, 6, P) by the parameters.

        A Jacobian maps a change of the parameters to the target's translation [m] and turn [rad]
        along the axes of the instrument. The joint `terms` do not depend on the parameters: they
        may be evaluated once for all calls.
        """
        terms = self.terms(joints) if terms is None else terms
        standing = self.standing(parameters, joints, terms)
        # exp(xi + dxi) M = exp(xi) M exp(inv(M) J dxi): a motion in the frame of the placed joint
        motions = [
            into @ pin.Jexp6(pin.Motion(twist))
            for into, twist in zip(self._into, self.twists(parameters), strict=True)
        ]
        count, links, placed = self._joints, 6 * self._joints, self._placed(parameters)
        poses = np.empty((len(joints), 4, 4))
        jacobians = np.zeros((len(joints), 6, len(parameters)))
        for sight, rows in by_sight(targets, len(joints)):
            arm, (start, end) = self._to(sight, placed, self._moving), self._ends[sight]
            poses[rows], by_joint, placements = arm.forward_and_all_jacobians(standing[rows])
            by_twist = np.stack([motions[start], *motions[1:count], motions[end]])
            by_link = placements.reshape(-1, count + 1, 6).swapaxes(0, 1) @ by_twist
            by_link = by_link.swapaxes(0, 1).reshape(len(by_joint), 6, -1)
            jacobians[rows, :, 6:links] = by_link[..., 6:links]
            jacobians[rows, :, 6 * start : 6 * start + 6] = by_link[..., :6]
            jacobians[rows, :, 6 * end : 6 * end + 6] = by_link[..., links:]
            by_term = by_joint[:, :, None] * terms[rows][:, None]
            jacobians[rows, :, self._geometry :] = by_term.reshape(len(by_joint), 6, -1)
        return poses, jacobians


def by_sight(sights: np.ndarray | None, count: int) -> list[tuple[int, slice | np.ndarray]]:
    """Each sight that occurs in the rows, with its rows."""
    if sights is None or not np.any(sights):
        return [(0, slice(count))]
    return [(sight, np.flatnonzero(sights == sight)) for sight in np.unique(sights)]
