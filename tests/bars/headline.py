"""What the headline says with a camera, over the true error: python -m tests.bars.headline.

A UR5 before a fixed camera and a Panda with the camera on the hand, off as in tests/identification/
real.py. 30 pictures of the default board about 1 m away, corners off by 0.1 px, lens, camera and
board unknown. True errors are means over 100 fresh postures, after one shift of base and tool.
"""

import sys
import tempfile
from pathlib import Path

import numpy as np

from recalib import Observations, load_arm
from recalib.identification.closed_forms import solutions
from recalib.identification.validation import BLOCKWISE
from recalib.laboratory.pictures.sessions import calibrate_pictures
from tests.identification.real import Real
from tests.vision.rendering import Cell, frame
from tests.vision.sessions import write_views

ARMS = {"UR5": ("ur5_robot.urdf", "tool0"), "Panda": ("panda.urdf", "panda_link8")}
MIDDLES = {"UR5": [0.3, -1.9, 2.0, -0.1, 1.27, 0.2], "Panda": [0, 0.1, 0, -1.9, 0, 2.0, 0.8]}  # rad
DRAWS, PICTURES, FRESH, NOISE, WIDE = 40, 30, 100, 0.1, 0.8  # px, rad


class AtOneMetre(Cell):
    """A cell in which the board is about 1 m before the camera."""

    def __init__(self, name: str, seed: int, in_hand: bool):
        self.name = name
        super().__init__(seed, in_hand)

    def __post_init__(self):
        self.arm = load_arm(*ARMS[self.name])
        self.real, self.random = Real(self.arm, self.seed), np.random.default_rng([self.seed, 2])
        turn, place = (scale * self.random.uniform(-1, 1, 3) for scale in (0.2, 0.05))
        off, middle = frame(turn, place), frame([0, 0, 0], [*-self.board.size / 2, 0])
        (tool,) = self.tool(np.array([MIDDLES[self.name]]))
        if self.in_hand:
            self.eye = frame([0, 0, 0.3], [0.06, 0.02, 0.05]) @ off
            self.sheet = tool @ self.eye @ frame([0, 0, 0], [0, 0, 1.0]) @ off @ middle
        else:
            back = frame([np.pi, 0, 0], [0, 0, 0.05]) @ off
            self.sheet = back @ middle
            self.eye = tool @ back @ frame([0, 0, 0], [0, 0, -1.0]) @ off

    def postures(self, count: int) -> np.ndarray:
        """Postures (count, joints) [rad] in which the whole board is in the picture."""
        model, middle, postures = self.arm.model, np.array(MIDDLES[self.name]), []
        low, high = model.lowerPositionLimit, model.upperPositionLimit
        while len(postures) < count:
            candidates = middle + WIDE * self.random.uniform(-1, 1, (400, len(middle)))
            candidates = candidates[((candidates > low) & (candidates < high)).all(axis=1)]
            for joints, pose in zip(candidates, self.board_poses(candidates), strict=True):
                depths = self.board.points @ pose[2, :3] + pose[2, 3]
                facing = pose[:3, 2] @ pose[:3, 3] / np.linalg.norm(pose[:3, 3])
                if depths.min() > 0.6 and depths.max() < 1.4 and facing > 0.55:
                    pixels = self.project(pose)
                    if (pixels > 30).all() and (pixels < np.subtract(self.lens.size, 30)).all():
                        postures.append(joints)
        return np.array(postures[:count])


def draw(name: str, seed: int, in_hand: bool) -> tuple[float, float]:
    """The error [mm] that is stated, and the true one."""
    cell = AtOneMetre(name, seed, in_hand)
    joints, fresh = cell.postures(PICTURES), cell.postures(FRESH)
    views = [cell.view(pose, NOISE) for pose in cell.board_poses(joints)]
    with tempfile.TemporaryDirectory() as folder:
        observed = write_views(Path(folder), cell, joints, views)
        result = calibrate_pictures(ARMS[name][0], [observed], tool=ARMS[name][1])
    poses, true = result.calibration.forward(fresh), cell.tool(fresh)
    frames = next(solutions(poses, Observations(fresh, true)))
    gaps = (frames.base @ poses @ frames.targets[0] - true)[:, :3, 3]
    stated = result.validation.mean_error(BLOCKWISE, result.validation.chosen)
    return 1e3 * stated, 1e3 * float(np.linalg.norm(gaps, axis=1).mean())


if __name__ == "__main__":
    draws = int(sys.argv[1]) if sys.argv[1:] else DRAWS
    for name, in_hand in (("UR5", False), ("Panda", True)):
        stated, true = np.array([draw(name, seed, in_hand) for seed in range(draws)]).T
        ratio = np.median(stated / true)
        print(
            f"{name}: stated {np.median(stated):.3f} mm, true {np.median(true):.3f} mm; {ratio:.2f}"
        )
