"""Stated errors over those of fresh rows: python -m tests.bars.stated [SEEDS] prints the table.

Simulated arms, off as in tests/identification/real.py, 60 poses with a noise of 0.1 mm and 0.01
degrees in a box of joint space unless a name says otherwise. Fresh rows, as noisy, lie in the same
box and in one half as wide again. What is stated should be within 20 % of what they show, but for
joints and arms that are named as not what their columns say.
"""

import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
import pinocchio as pin
from scipy.spatial.transform import Rotation

from recalib import Arm, load_arm
from recalib.identification.validation import BLOCKWISE, RANDOM
from recalib.laboratory.calibrate import calibrate
from recalib.nominal.arms import arm_of
from tests.arms import GANTRY, INDUSTRIAL, RAILED, SCARA, urdf
from tests.identification.real import Real

NOISE, FRESH, HALF = (1e-4, np.radians(0.01)), 400, 0.8  # m, rad; rad
FIVE = urdf(
    ("turn", "revolute", "0 0 1", "0 0 0.3"),
    ("lift", "revolute", "0 1 0", "0.05 0 0"),
    ("reach", "revolute", "0 1 0", "0 0 0.4"),
    ("pitch", "revolute", "0 1 0", "0.35 0 0"),
    ("spin", "revolute", "1 0 0", "0.1 0 0.02"),
    ("flange", "fixed", "0 0 1", "0.08 0 0"),
    mass=4.0,
)
NAMED = {
    "UR10": ("ur10_robot.urdf", "tool0"),
    "UR3": ("ur3_robot.urdf", "tool0"),
    "Panda": ("panda.urdf", "panda_link8"),
    "xArm": ("xarm7.urdf", "link_eef"),
    "Jaco": ("kinova.urdf", "j2s6s200_end_effector"),
}
TEXTS = {
    "SCARA": SCARA,
    "Cartesian": GANTRY,
    "industrial": INDUSTRIAL,
    "rail + 6": RAILED,
    "5 joints": FIVE,
}


@cache
def arm_called(name: str) -> Arm:
    return (
        load_arm(*NAMED[name]) if name in NAMED else arm_of(TEXTS[name].encode(), Path("arm.urdf"))
    )


@dataclass
class Setup:
    """An arm with errors, and how it is measured.

    Attributes:
        gears, sag, backlash: rad; sag that of the joint with the largest torque.
        gain: a joint, another and a share of its column by which the first turns in addition.
        warming: by what part the arm grows while it is measured; fresh rows are of the cold one.
        outliers: the part of rows that are off by 10 mm; noisy: that of those six times as noisy.
        noise: over `NOISE`.
    """

    arm: str
    positions: bool = False
    rows: int = 60
    half: float = HALF
    gears: float = 0.0
    sag: float = 0.0
    backlash: float = 0.0
    gain: tuple[int, int, float] | None = None
    warming: float = 0.0
    outliers: float = 0.0
    noisy: float = 0.0
    noise: float = 1.0


class Cell(Real):
    """A setup as it is.

    Attributes:
        box: rad, m: the lowest and highest joint coordinates (joints,) that are measured.
        noise: m, rad.
    """

    def __init__(self, setup: Setup, seed: int):
        self.setup, self.nominal = setup, arm_called(setup.arm)
        super().__init__(self.nominal, seed, gears=setup.gears)
        self._waves[2] = 0.0  # each joint's own, as gears are
        self._waves[:, self.nominal.slides] = 0.0
        self.noise = setup.noise * np.array(NOISE)
        low, high = (np.clip(limit, -np.pi, np.pi) for limit in self._limits)
        middle, reach = (low + high) / 2, (high - low) / 2
        if setup.arm == "UR10":
            middle = np.radians([20, -65, 100, -40, 95, 10])
        half = np.where(self.nominal.slides, reach / 8, np.minimum(setup.half, reach))
        self.box = middle - half, middle + half

    def _standing(self, joints: np.ndarray) -> np.ndarray:
        setup, model = self.setup, self.nominal.model
        angles = super()._standing(joints)
        if setup.sag and not self.nominal.massless:
            data = model.createData()
            torques = [pin.computeGeneralizedGravity(model, data, q).copy() for q in joints]
            angles -= setup.sag * np.array(torques) / np.abs(torques).max()
        angles += setup.backlash / 2 * self.random.choice([-1, 1], joints.shape)
        if setup.gain:
            joint, by, share = setup.gain
            angles[:, joint] += share * joints[:, by]
        return angles

    def joints(self, count: int, wide: float = 1.0) -> np.ndarray:
        """Of postures (count, joints) [rad, m] in the box, or in one that is so much wider."""
        low, high = self.box
        further = (wide - 1) / 2 * (high - low)
        drawn = self.random.uniform(low - further, high + further, (count, len(low)))
        return drawn if wide == 1 else np.clip(drawn, *self._limits)

    def measured(self, joints: np.ndarray, warming: bool = False) -> np.ndarray:
        """Poses (n, 4, 4) or positions (n, 3) [m], with noise."""
        setup, random, count = self.setup, self.random, len(joints)
        poses = np.linalg.inv(self.base) @ self.poses(joints, noise=(0, 0))
        if warming:
            poses[:, :3, 3] *= 1 + setup.warming * np.linspace(0, 1, count)[:, None]
        poses = self.base @ poses
        scale = np.where(random.random(count) < setup.noisy, 6.0, 1.0)[:, None]
        shifts, turns = self.noise[:, None, None] * scale * random.standard_normal((2, count, 3))
        poses[:, :3, 3] += shifts
        poses[:, :3, :3] = Rotation.from_rotvec(turns).as_matrix() @ poses[:, :3, :3]
        return poses[:, :3, 3] if setup.positions else poses

    def known(self) -> tuple[np.ndarray, np.ndarray]:
        """Joints and what is measured to calibrate, some of it grossly off."""
        joints = self.joints(self.setup.rows)
        measured = self.measured(joints, warming=True)
        outliers = self.random.random(len(joints)) < self.setup.outliers
        places = measured if self.setup.positions else measured[:, :3, 3]
        places[outliers] += 0.01 * self.random.choice([-1, 1], (np.count_nonzero(outliers), 3))
        return joints, measured


SETUPS = {
    "6 joints, geometry": Setup("UR10"),
    "6 joints, positions": Setup("UR10", positions=True, rows=80),
    "6 joints, gears, sag": Setup("UR10", gears=1e-3, sag=2e-3),
    "6 joints, gears, sag, 80 positions": Setup(
        "UR10", positions=True, rows=80, gears=1e-3, sag=2e-3
    ),
    "6 joints, all the way round": Setup("UR10", half=np.pi, gears=1e-3, sag=2e-3),
    "7 joints, gears, sag, backlash": Setup("Panda", gears=1e-3, sag=2e-3, backlash=3e-4),
    "industrial": Setup("industrial"),
    "SCARA": Setup("SCARA"),
    "5 joints, soft": Setup("5 joints", sag=4e-3),
    "rail + 6": Setup("rail + 6"),
    "Cartesian": Setup("Cartesian"),
    "Cartesian, positions": Setup("Cartesian", positions=True),
    "6 joints, backlash 1 mrad": Setup("UR10", backlash=1e-3),
    "5 % of rows off by 10 mm": Setup("UR10", outliers=0.05),
    "20 rows": Setup("UR10", rows=20),
    "a third six times as noisy": Setup("UR10", noisy=1 / 3),
    "warms up": Setup("UR10", warming=8e-4),
    "joint 3 moves 5 % less": Setup("UR10", gain=(2, 2, -0.05)),
    "joint 6 turns by 2 % of joint 5": Setup("UR10", gain=(5, 4, 0.02)),
}


def errors_and_faults(setup: Setup, seed: int) -> tuple[list[float], str]:
    """Errors [mm] stated, away and near, and met, in the box and a wider one; and what is named."""
    cell = Cell(setup, seed)
    result = calibrate(cell.nominal, *cell.known())
    chosen = result.validation.chosen
    errors = [result.validation.mean_error(split, chosen) for split in (BLOCKWISE, RANDOM)]
    for wide in (1.0, 1.5):
        joints = cell.joints(FRESH, wide)
        measured = cell.measured(joints)
        predicted = result.predict(joints)[:, :3, 3]
        places = measured if setup.positions else measured[:, :3, 3]
        errors.append(np.linalg.norm(predicted - places, axis=1).mean())
    named = [fault.kind for fault in result.faults] + ["gain"] * bool(result.wrong_gain)
    return [1e3 * error for error in errors], " ".join(named)


def table(seeds: int, report: Callable[[str], None] = print) -> None:
    report("| arm | stated [mm], away / near | met, same box / wider | over same box | named |")
    report("| --- | --- | --- | --- | --- |")
    for name, setup in SETUPS.items():
        draws = [errors_and_faults(setup, seed) for seed in range(seeds)]
        blockwise, random, same, wider = np.mean([errors for errors, _ in draws], axis=0)
        named = ", ".join(sorted({names for _, names in draws if names}))
        stated, true = f"{blockwise:.3f} / {random:.3f}", f"{same:.3f} / {wider:.3f}"
        ratios = f"{blockwise / same:.2f} / {random / same:.2f}"
        report(f"| {name} | {stated} | {true} | {ratios} | {named} |")


if __name__ == "__main__":
    table(int(sys.argv[1]) if sys.argv[1:] else 3)
