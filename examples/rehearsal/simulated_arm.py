"""An arm in MuJoCo as a station: joints give way, rub and have play. It stands for a real arm.

Geometry and masses come from a URDF, damaged as `recalib.damaged` does it; all that moves is
MuJoCo's. A joint is a motor, a gear, and what the gear carries. The encoder sits on the motor,
which stands exactly where the controller wants it. The gear is a spring, which gives way to
gravity, with friction and play. So only the instrument sees how far a joint droops.
"""

import os
import sys
import threading
from collections.abc import Mapping
from ctypes.util import find_library
from dataclasses import dataclass

import numpy as np

from recalib.damaged.damage import DamagedArm
from recalib.damaged.disturbances import Disturbances
from recalib.errors import UnsuitableRobot
from recalib.nominal.kinematics import Arm
from recalib.station.interface import StationFailed, cells_of

if sys.platform == "linux" and find_library("EGL"):  # to draw without a screen
    os.environ.setdefault("MUJOCO_GL", "egl")  # MuJoCo looks here when it is imported

import mujoco

STEP = 0.004  # s
CHUNK = 25  # steps between two looks at whether it stands
STILL = 1e-6  # rad or m in a chunk
PATIENCE = 300  # chunks in which it must stand
# rad/s: no joint swings faster, whatever it carries: its motor's rotor, which turns many times as
# fast, has to be moved, too. Time steps are as long as that allows.
FASTEST = 100.0
SPEED = 1.0  # rad/s or m/s of a joint of which the URDF does not say how fast it is
SAMPLES = 100  # postures among which is the one that is hardest to swing
HARD = 0.9999  # the hardest contact that MuJoCo knows: softer ones creep
WIDTH = 0.04  # m, half the width of links in pictures


@dataclass(frozen=True)
class Gears:
    """What keeps the joints from standing where their motors do, each a number or (joints,).

    Attributes:
        stiffness: N m/rad, or N/m where a joint slides.
        friction: N m, or N, up to which a joint does not move.
        play: rad, or m, from one side of a gear's gap to the other.
    """

    stiffness: float | np.ndarray = 2e4
    friction: float | np.ndarray = 0.0
    play: float | np.ndarray = 0.0


class PhysicsStation:
    """An arm in MuJoCo with its untouched controller, and an instrument: see `Station`.

    Args:
        damaged: the arm that moves. Its offsets and deflections are between motors and encoders.
            `Sag` and `Backlash` are none of them: gears have both.
        gears: between motors and links.
        instrument: its pose (4, 4) in the arm's base [m].
        target: the pose (4, 4) [m] of the measured target in the tool.
        disturbances: of moves and measurements.
        seed: of these.

    Raises UnsuitableRobot for links without masses.
    """

    def __init__(
        self,
        damaged: DamagedArm,
        gears: Gears | None = None,
        instrument: np.ndarray | None = None,
        target: np.ndarray | None = None,
        disturbances: Disturbances | None = None,
        seed: int = 0,
    ):
        self._damaged, arm, gears = damaged, damaged.arm, gears or Gears()
        if arm.massless:
            raise UnsuitableRobot("links without masses have no dynamics; try: a URDF with masses")
        half = np.broadcast_to(gears.play, arm.model.nv) / 2
        self._gaps = np.stack([-half, half], axis=1)
        self._instrument = np.eye(4) if instrument is None else instrument
        self._target = np.eye(4) if target is None else target
        self._disturbances = disturbances or Disturbances()
        self._rng = np.random.default_rng(seed)
        self._stopped = threading.Event()
        self.joints, model = arm.joints, arm.model
        self.limits = model.lowerPositionLimit.copy(), model.upperPositionLimit.copy()
        fast = np.array(model.velocityLimit)
        self._speeds = np.where((fast > 0) & np.isfinite(fast), fast, SPEED)
        self._model = self._scene(_spec(arm, gears)).compile()
        self._data = mujoco.MjData(self._model)
        _damp(self._model, self._data, self.limits)
        self._angles = np.clip(np.zeros(len(self.joints)), *self.limits)
        self._hold(self._angles)
        self._data.qpos[:] = self._motors
        self._settle()

    def _scene(self, spec: mujoco.MjSpec) -> mujoco.MjSpec:
        """The arm with what else there is."""
        return spec

    def move(self, angles: np.ndarray, speed: float = 1.0) -> None:
        """Go to joint angles (joints,) [rad, m]; see `Station`."""
        low, high = self.limits
        if not ((angles >= low) & (angles <= high)).all():  # which no NaN is
            raise StationFailed(f"{angles} is not within the limits of the joints")
        start, way = self._angles, angles - self._angles
        seconds = np.pi / 2 * np.max(np.abs(way) / self._speeds) / speed
        errors = self._disturbances.of_joints([self._rng], (1, len(way)))[0, 0]
        errors[self._damaged.arm.slides] = 0  # an angle is no length
        for time in np.arange(0.0, seconds, STEP):
            if self._stopped.is_set():
                break
            self._hold(start + way * (1 - np.cos(np.pi * time / seconds)) / 2)
            mujoco.mj_step(self._model, self._data)
        else:
            if not self._stopped.is_set():
                self._hold(angles, errors)
        self._settle()
        if self._stopped.is_set():
            raise StationFailed("it was stopped")

    def _hold(self, angles: np.ndarray, errors: np.ndarray | float = 0.0) -> None:
        """Have the encoders say these angles (joints,), of motors that miss them by a little."""
        self._angles = angles.copy()
        self._motors = self._damaged.standing(angles[None])[0] + errors
        self._model.tendon_lengthspring[:] = self._motors[:, None] + self._gaps

    def _settle(self) -> None:
        for _ in range(PATIENCE):
            before = self._data.qpos.copy()
            mujoco.mj_step(self._model, self._data, CHUNK)
            if np.abs(self._data.qpos - before).max() < STILL:
                mujoco.mj_kinematics(self._model, self._data)
                return
        raise StationFailed(f"it does not stand still after {PATIENCE * CHUNK * STEP:g} s")

    def angles(self) -> np.ndarray:
        """Where the encoders say it is: (joints,) rad, m."""
        return self._angles.copy()

    def pose(self) -> np.ndarray:
        """The pose (4, 4) of the tool in the base [m]: the truth, which no instrument sees."""
        tool, pose = self._data.site("tool"), np.eye(4)
        pose[:3, :3], pose[:3, 3] = tool.xmat.reshape(3, 3), tool.xpos
        return pose

    def forward(self, angles: np.ndarray) -> np.ndarray:
        """True poses (n, 4, 4) of the tool [m], after moves to each of angles (n, joints) [rad].

        So a station is what moves in a `Plant`, which also passes on what its controller refuses:
        joints go to their limits and no farther.
        """
        poses = np.empty((len(angles), 4, 4))
        for pose, goal in zip(poses, angles, strict=True):
            self.move(np.clip(goal, *self.limits))
            pose[:] = self.pose()
        return poses

    def measure(self) -> Mapping[str, float | str] | None:
        """The pose of the target in the instrument's frame, with its noise; see `Station`."""
        exact = np.linalg.inv(self._instrument) @ self.pose() @ self._target
        return cells_of(self._disturbances.measure([self._rng], exact[None, None])[0, 0])

    def stop(self) -> None:
        """Stand still, now, and move no more; see `Station`."""
        self._stopped.set()


def _spec(arm: Arm, gears: Gears) -> mujoco.MjSpec:
    """The arm as MuJoCo has it, with a site `tool`, and capsules for who looks at it."""
    spec, model = mujoco.MjSpec(), arm.model
    spec.option.timestep = STEP
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    spec.option.gravity = model.gravity.linear
    # URDFs have links without mass, and inertias that no body has
    spec.compiler.boundmass, spec.compiler.boundinertia = 1e-6, 1e-9
    spec.compiler.balanceinertia = True
    count, body = model.nv, spec.worldbody
    stiffness, friction = (
        np.broadcast_to(given, count) for given in (gears.stiffness, gears.friction)
    )
    tool = arm.end.placement
    ends = [*list(model.jointPlacements)[2:], tool]
    for index, name in enumerate(arm.joints):
        body = body.add_body(name=name, **placed(model.jointPlacements[index + 1].homogeneous))
        carried = model.inertias[index + 1]
        (xx, xy, xz), (_, yy, yz), (_, _, zz) = carried.inertia
        body.mass, body.ipos = carried.mass, carried.lever
        body.fullinertia = [xx, yy, zz, xy, xz, yz]
        body.explicitinertial = True
        slides = mujoco.mjtJoint.mjJNT_SLIDE, mujoco.mjtJoint.mjJNT_HINGE
        body.add_joint(
            name=name,
            armature=stiffness[index] / FASTEST**2,
            frictionloss=friction[index],
            solimp_friction=[HARD, HARD, 0.001, 0.5, 2],
            solref_friction=[2 * STEP, 1],
            type=slides[not arm.slides[index]],
            axis=arm.axes[index],
        )
        spring = spec.add_tendon(name=name, stiffness=np.array([stiffness[index], 0, 0]))
        spring.wrap_joint(name, 1.0)
        end = np.array(ends[index].translation)
        if np.linalg.norm(end) > 1e-6:
            round_end, flat = mujoco.mjtGeom.mjGEOM_CAPSULE, mujoco.mjtGeom.mjGEOM_CYLINDER
            body.add_geom(
                type=flat if index == count - 1 else round_end,  # a tool may begin there
                fromto=[0, 0, 0, *end],
                size=[WIDTH, 0, 0],
                contype=0,
                conaffinity=0,
                mass=0,
                rgba=[0.6, 0.6, 0.65, 1],
            )
    body.add_site(name="tool", **placed(tool.homogeneous))
    return spec


def placed(pose: np.ndarray) -> dict[str, np.ndarray]:
    """Where something is, by its pose (4, 4) [m], in MuJoCo's words."""
    turn = np.empty(4)
    mujoco.mju_mat2Quat(turn, pose[:3, :3].ravel())
    return {"pos": pose[:3, 3], "quat": turn}


def _damp(model: mujoco.MjModel, data: mujoco.MjData, limits: tuple[np.ndarray, ...]) -> None:
    """Have each joint damped as it needs where it is hardest to swing."""
    low, high = (np.clip(limit, -np.pi, np.pi) for limit in limits)
    heaviest, inertia = np.zeros(model.nv), np.empty((model.nv, model.nv))
    for angles in np.random.default_rng(0).uniform(low, high, (SAMPLES, model.nv)):
        data.qpos[:] = angles
        mujoco.mj_forward(model, data)
        mujoco.mj_fullM(model, data, inertia)
        heaviest = np.maximum(heaviest, inertia.diagonal())
    model.dof_damping[:] = 2 * np.sqrt(model.tendon_stiffness * heaviest)
