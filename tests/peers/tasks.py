"""What is to be calibrated: the same rows to learn from and to be judged on, for all packages."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.identification.model.observations import Observations
from recalib.laboratory.tables.description import read_description
from recalib.laboratory.tables.measurements import read_measurements
from recalib.nominal import find_urdf
from recalib.nominal.arms import load_arm
from recalib.nominal.kinematics import Arm
from tests.identification.real import ARMS, NOISE, Real

UR5 = Path(__file__).parents[2] / "workflow" / "real" / "ur5.toml"
POSES, FRESH = 30, 200
# Of the real arm's positions: how many random ones, by how many positions are in each.
SUBSETS = {20: 5, 100: 5, 1000: 1}
SHORTENED, SHIFTED = (0.01, 0.01, 0.04), np.radians([4, 3, 4])  # m, rad: the damage of the paper
SHORTEST = 0.05  # m: a link that can lose as much as that
OUTLIERS, FAR = 0.1, 0.05  # the share of poses that are measured this far off [m]


@dataclass(frozen=True)
class Task:
    """Rows to learn from, and others to be judged on.

    Attributes:
        scenario: its name.
        draw: its number among those of the scenario.
        arm: the nominal one.
        urdf: its file.
        observations: what there is to learn from, in the frame of the instrument.
        fresh: (m, joints) rad, the postures to be judged on.
        truth: poses (m, 4, 4) or positions (m, 3) [m] of the target there, in the same frame.
        frames: the poses (4, 4) of the arm's base in the frame of the instrument, and of the target
            on the tool [m]: peers get them, we do not. None: peers do not get them either.
        known: whether the noise is that of the simulated arms: peers get it, we do not.
    """

    scenario: str
    draw: int
    arm: Arm
    urdf: Path
    observations: Observations
    fresh: np.ndarray
    truth: np.ndarray
    frames: tuple[np.ndarray, np.ndarray] | None
    known: bool = True

    @property
    def name(self) -> str:
        """Of its files."""
        return f"{self.scenario}-{self.draw:03}"

    def in_base(self, measured: np.ndarray) -> np.ndarray:
        """Poses of the target as those of the tool in the arm's base, if the frames are known.

        Positions (n, 3) [m] stay those of the target.
        """
        if self.frames is None:
            return measured
        base, target = self.frames
        if measured.ndim == 2:
            return (measured - base[:3, 3]) @ base[:3, :3]
        return np.linalg.inv(base) @ measured @ np.linalg.inv(target)

    def error(self, positions: np.ndarray) -> float:
        """The mean distance [m] of predicted positions (m, 3), as `in_base`, to the truth."""
        gaps = positions - _positions(self.in_base(self.truth))
        return float(np.linalg.norm(gaps, axis=1).mean())

    def predicted(self, poses: np.ndarray) -> np.ndarray:
        """Positions (m, 3) [m], as `in_base`, from predicted poses (m, 4, 4) of the target."""
        positions_alone = self.truth.ndim == 2
        return _positions(self.in_base(_positions(poses) if positions_alone else poses))

    def nominal(self) -> np.ndarray | None:
        """Positions (m, 3) [m] of the nominal arm, as `in_base`; None if the frames are unknown."""
        if self.frames is None:
            return None
        return _positions(self.arm.forward(self.fresh) @ self._judged)

    @property
    def _judged(self) -> np.ndarray:
        """The pose (4, 4) in the tool's frame of what is judged."""
        return self.frames[1] if self.frames and self.truth.ndim == 2 else np.eye(4)

    def write(self, folder: Path) -> None:
        """Write a file for the peers, as arrays, since they lack our classes; without the truth."""
        home, jacobians = self.arm.forward_and_jacobian(np.zeros((1, len(self.arm.joints))))
        turning, moving = jacobians[0, 3:].T, jacobians[0, :3].T
        np.savez(
            folder / f"{self.name}.npz",
            urdf=str(self.urdf),
            packages=str(self.urdf.parents[4]),  # below which meshes are found
            tool=self.arm.tool,
            names=np.array(self.arm.joints),
            joints=self.observations.joints,
            measured=self.in_base(self.observations.measured),
            fresh=self.fresh,
            told=self.frames is not None,
            noise=np.array(NOISE),
            known=self.known,
            # of every joint at zero, the moment and the direction of its axis in the base's frame
            screws=np.hstack([moving - np.cross(turning, home[0, :3, 3]), turning]),
            home=home[0] @ self._judged,
        )


def _positions(measured: np.ndarray) -> np.ndarray:
    return measured if measured.ndim == 2 else measured[:, :3, 3]


class Shortened(Real):
    """An arm with the paper's damage: three links shortened, three joints off, all else right."""

    def __init__(self, nominal: Arm, seed: int):
        super().__init__(nominal, seed)
        self._arm, count = nominal.copy(), len(nominal.joints)
        placements = self._arm.model.jointPlacements
        lengths = [np.linalg.norm(placement.translation) for placement in placements]
        long = [joint for joint in range(2, count + 1) if lengths[joint] > SHORTEST]
        for joint, lost in zip(self.random.permutation(long).tolist(), SHORTENED, strict=False):
            placements[joint].translation *= 1 - lost / lengths[joint]
        self._offsets = np.zeros(count)
        signs = self.random.choice([-1, 1], len(SHIFTED))
        self._offsets[self.random.permutation(count)[: len(SHIFTED)]] = signs * SHIFTED


def simulated(
    scenario: str,
    name: str,
    kind: type[Real],
    draw: int,
    frames_known: bool = True,
    outliers: float = 0.0,
) -> Task:
    """A draw of an arm, by its name, with poses to learn from, a part of which is far off."""
    arm, urdf = load_arm(*ARMS[name]), find_urdf(ARMS[name][0])
    real = kind(arm, draw)
    joints, fresh = real.postures(POSES), real.postures(FRESH)
    measured = real.poses(joints)
    outlying = real.random.permutation(POSES)[: round(outliers * POSES)]
    directions = Rotation.random(POSES, rng=real.random).as_matrix()[:, 0]
    measured[outlying, :3, 3] += FAR * directions[outlying]
    observations, truth = Observations(joints, measured), real.poses(fresh, noise=(0, 0))
    frames = (real.base, real.targets[0]) if frames_known else None
    return Task(scenario, draw, arm, urdf, observations, fresh, truth, frames)


def recorded(folder: Path) -> Iterator[Task]:
    """Of a real UR5: random subsets of the 1,000 positions, and the 20 others to be judged on."""
    description = read_description(UR5)
    arm, urdf = load_arm("ur5_robot.urdf", "tool0"), find_urdf("ur5_robot.urdf")
    known, tests = (
        read_measurements(folder / f"{name}.csv", arm, description)
        for name in ("grid_1000", "random_20")
    )
    frames = np.linalg.inv(description.instrument), description.target
    for count, subsets in SUBSETS.items():
        for subset in range(subsets):
            rows = np.sort(np.random.default_rng(subset).permutation(len(known))[:count])
            own = Observations(known.joints[rows], known.positions[rows])
            fresh, truth = tests.joints, tests.positions
            yield Task(f"ur5_{count}", subset, arm, urdf, own, fresh, truth, frames, known=False)


def tasks(draws: int, recording: Path | None) -> Iterator[Task]:
    """All tasks."""
    for draw in range(draws):
        yield simulated("panda", "Panda", Real, draw)
        yield simulated("ur10", "UR10", Shortened, draw)
        yield simulated("ur10_outliers", "UR10", Shortened, draw, outliers=OUTLIERS)
        yield simulated("untold", "Panda", Real, draw, frames_known=False)
    if recording is not None:
        yield from recorded(recording)
