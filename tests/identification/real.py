"""An arm as it is, with an instrument somewhere and targets somewhere on its tool."""

from collections.abc import Callable

import numpy as np
import pinocchio as pin
from scipy.spatial.transform import Rotation

from recalib import OFFSETS, Calibration, Observations, initial_frames
from recalib.identification import identify
from recalib.identification.model import ErrorModel, nearest_rotation

ARMS = {"UR10": ("ur10_robot.urdf", "tool0"), "Panda": ("panda.urdf", "panda_link8")}
NOISE = 2e-4, np.radians(0.02)  # m, rad
BALL, SOCKETS = np.array([0.02, -0.01, 0.12]), np.array([[0.45, -0.15, 0.1], [0.45, 0.15, 0.1]])


def anywhere(random, reach):
    turn = Rotation.random(rng=random).as_matrix()
    return pin.SE3(turn, random.uniform(-reach, reach, 3)).homogeneous


def geometry_of(arm, observations: Observations) -> Calibration:
    """An arm of which nothing but geometry is identified, with frames that nobody knows."""
    model = ErrorModel(arm, OFFSETS, initial_frames(arm, observations))
    return Calibration(model, identify(model, observations))


class Real:
    """An arm with links off by 1 mm and 0.1 degrees, joints by 1 degree or 1 mm.

    Gears [rad] are as eccentric as that, in turns, in half turns, and together with the joint
    before them, which no model here holds.
    """

    def __init__(self, nominal, seed, targets=1, gears=0.0):
        self.random = np.random.default_rng(seed)
        model, count = ErrorModel(nominal, OFFSETS), len(nominal.joints)
        links = np.repeat([[1e-3, np.radians(0.1)]], 3, axis=1).repeat(count + 1, axis=0)
        offsets = np.where(nominal.slides, 1e-3, np.radians(1))
        parameters = np.concatenate([links.ravel(), offsets])
        parameters *= self.random.standard_normal(len(parameters))
        self._arm, self._offsets = model.arm(parameters), parameters[-count:]
        random = np.random.default_rng([seed, 1])
        self._waves = gears * random.standard_normal((3, count))
        self._phases = random.uniform(0, 2 * np.pi, (2, count))
        self._limits = nominal.model.lowerPositionLimit, nominal.model.upperPositionLimit
        self.base = anywhere(self.random, 2.0)
        self.targets = np.array([anywhere(self.random, 0.2) for _ in range(targets)])

    def postures(self, count):
        low, high = (np.clip(limit, -np.pi, np.pi) for limit in self._limits)
        return self.random.uniform(low, high, (count, len(low)))

    def touching(self, ball, socket, count):
        """Postures (count, joints) in which a ball at a point of the tool sits in a socket [m].

        The socket is in the arm's base; the ball sits there to a tenth of a millimetre.
        """
        starts = 20 * count
        goals = socket + 1e-4 * self.random.standard_normal((starts, 3))
        joints = self.postures(starts)
        for _ in range(30):
            tool, jacobians = self._arm.forward_and_jacobian(joints + self._offsets)
            lever = tool[:, :3, :3] @ ball
            turning = np.cross(jacobians[:, 3:].swapaxes(1, 2), lever[:, None]).swapaxes(1, 2)
            residuals = goals - tool[:, :3, 3] - lever
            steps = np.linalg.pinv(jacobians[:, :3] + turning) @ residuals[..., None]
            joints = joints + np.clip(steps[..., 0], -0.3, 0.3)
        low, high = self._limits
        converged = (np.abs(residuals) < 1e-9).all(axis=1) & (joints > low).all(axis=1)
        found = joints[converged & (joints < high).all(axis=1)]
        assert len(found) >= count
        return found[:count]

    def ball(self, ball, joints):
        tool = self._arm.forward(joints + self._offsets)
        return tool[:, :3, 3] + tool[:, :3, :3] @ ball

    def _standing(self, joints):
        once, twice, coupled = self._waves
        first, second = self._phases
        gears = once * np.sin(joints + first) + twice / 2 * np.sin(2 * joints + second)
        gears += coupled * np.sin(joints + np.roll(joints, 1, axis=1))
        return joints + gears + self._offsets

    def poses(self, joints, targets=0, noise=NOISE):
        observations = self.base @ self._arm.forward(self._standing(joints)) @ self.targets[targets]
        turns = noise[1] * self.random.standard_normal((len(joints), 3))
        observations[:, :3, :3] = Rotation.from_rotvec(turns).as_matrix() @ observations[:, :3, :3]
        observations[:, :3, 3] += noise[0] * self.random.standard_normal((len(joints), 3))
        return observations

    def observe(self, count: int, positions: bool = False, targets=None) -> Observations:
        """What the instrument sees in other postures; the first target unless given (count,)."""
        joints = self.postures(count)
        poses = self.poses(joints, 0 if targets is None else targets)
        return Observations(joints, poses[:, :3, 3] if positions else poses, targets)

    def error(self, predict: Callable[[np.ndarray], np.ndarray]) -> float:
        """Mean error of position [m] in 200 fresh postures."""
        fresh = self.postures(200)
        gaps = predict(fresh) - self.poses(fresh, noise=(0, 0))
        return float(np.linalg.norm(gaps[:, :3, 3], axis=1).mean())


def aligned(points: np.ndarray, goals: np.ndarray) -> float:
    """The mean distance between points and goals (n, 3) after the best rigid motion."""
    points, goals = points - points.mean(axis=0), goals - goals.mean(axis=0)
    turned = points @ nearest_rotation(goals.T @ points).T
    return float(np.linalg.norm(goals - turned, axis=1).mean())
