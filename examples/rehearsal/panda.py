"""A station by pictures, rehearsed: a Panda in MuJoCo that is bent, with a board and a camera.

recalib board
python examples/rehearsal/panda.py   # pictures/ and joints.csv, for the lens
recalib observe pictures/ joints.csv --out lens
"""

import csv

import numpy as np
import pinocchio as pin
from simulated_arm import Gears
from simulated_camera import PicturedStation

from recalib import DamagedArm, load_arm
from recalib.vision import read_board

HOME = np.array([0, 0.1, 0, -1.9, 0, 3.0, 0.8])  # rad; the flange shows the board to the camera
STIFFNESS = 5e3  # N m/rad, of each gear: the arm droops by some millimetres


class BentPanda(PicturedStation):
    """Links are bent by 1 mm and 0.1 degrees, encoders shifted by half a degree."""

    def __init__(self, folder: str = "seen") -> None:
        rng, board = np.random.default_rng(1996), read_board("board/board.toml")
        arm = load_arm("panda.urdf", "panda_link8")
        placements = arm.model.jointPlacements
        for joint in range(1, 8):
            error = np.repeat([1e-3, np.radians(0.1)], 3) * rng.standard_normal(6)  # m, rad
            placements[joint] = placements[joint] * pin.exp6(pin.Motion(error))
        bent = DamagedArm(arm, np.radians(0.5) * rng.standard_normal(7))
        width, height = board.size
        place = pose([np.pi, 0, 0], [-width / 2, height / 2, 0.05])  # on the flange
        camera = pose([0, 0, np.pi / 2], [1.5, 0, 0.75]) @ pose([-1.75, 0, 0], [0, 0, 0])
        super().__init__(bent, camera, place, board, folder, Gears(STIFFNESS), seed=1996)
        self.move(HOME)


def pose(turn: list[float], place: list[float]) -> np.ndarray:
    """(4, 4) m from a rotation vector [rad] and a position [m]."""
    placed: np.ndarray = pin.SE3(pin.exp3(np.array(turn)), np.array(place)).homogeneous
    return placed


if __name__ == "__main__":
    station, rng = BentPanda("pictures"), np.random.default_rng(0)
    rows: list[list[str | float]] = []
    while len(rows) < 15:
        station.move(HOME + rng.uniform(-0.35, 0.35, 7))
        if (row := station.measure()) is not None:
            rows.append([str(row["picture"]).split("/")[-1], *station.angles()])
    with open("joints.csv", "w", newline="") as file:
        csv.writer(file).writerows([["picture", *(f"{it} [rad]" for it in station.joints)], *rows])
