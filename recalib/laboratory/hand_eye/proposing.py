"""Flange poses whose pictures teach most of where camera and board are.

Candidates are drawn: the flange within a box, the line of sight within a cone about the board's
normal, the board whole in the picture. Each pose is chosen given those that were measured and those
chosen before it.
"""

from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.errors import InvalidFile
from recalib.files.toml import read_toml
from recalib.identification.hand_eye import ONE_AXIS, information
from recalib.identification.hand_eye_model import ENDS, HandEye, Sights
from recalib.identification.model.linearisation import LEVER
from recalib.identification.model.optics import BOARD
from recalib.laboratory.hand_eye.pose_table import read_poses
from recalib.laboratory.hand_eye.results import HAND_EYE, POSES
from recalib.laboratory.live.allowed import Box
from recalib.laboratory.pictures.observed import IN_HAND, LENS, SETUP
from recalib.laboratory.propose import NoUsefulPosture
from recalib.numerics.randomness import generator
from recalib.vision.boards import Board, board_in
from recalib.vision.detection import Corners
from recalib.vision.lenses import Lens, read_lens
from recalib.vision.views import optics_of, predicted_views, projected, sighting

DRAWN, TRIED = 400, 40_000  # candidates, and draws for them
NOISE = 0.1  # px, of corners
BEYOND = 0.1  # m, about the box of measured poses


@dataclass(frozen=True)
class HandEyeFolder:
    """What a hand-eye calibration by pictures wrote: the calibration, and what its camera sees."""

    found: HandEye
    board: Board
    lens: Lens

    @classmethod
    def read(cls, folder: str | PathLike[str]) -> "HandEyeFolder":
        """Raises InvalidFile: it is none, or one by a table of targets."""
        home = Path(folder)
        if not (home / SETUP).is_file():
            raise InvalidFile(folder, "it has no hand-eye calibration by pictures")
        values, setup = read_toml(home / HAND_EYE), read_toml(home / SETUP)
        board, lens = board_in(setup, home / SETUP), read_lens(home / LENS)
        camera, target = (np.array(values[name]["matrix"]) for name in ("camera", "board"))
        robot = values["robot"]
        accuracy = np.array([1e-3 * robot["millimetres"], np.radians(robot["degrees"])])
        flange, in_hand = read_poses(home / POSES).poses, setup["camera"] == IN_HAND
        optics, weights = np.zeros(len(BOARD)), np.ones(len(flange))
        rest = optics, accuracy, np.zeros(2), np.zeros((ENDS, ENDS)), weights
        blank = HandEye(Sights(flange, flange, in_hand), camera, target, *rest)
        found = cls(blank, board, lens)
        return replace(found, found=replace(blank, sights=found.seen(flange)))

    def seen(self, flange: np.ndarray) -> Sights:
        """What pictures would show from poses (n, 4, 4) of the flange, with `NOISE`."""
        sights = replace(self.found.sights, flange=flange)
        views = []
        for pose in self.found.predict(sights):
            pixels, _ = projected(self.board.points, self.lens, pose)
            view = Corners(np.arange(len(pixels)), pixels, 0.0)
            views.append(sighting(self.board, self.lens, view, False, False, pose))
        noisy = [one._replace(squares=NOISE**2 * one.free) for one in views]
        poses, optics = optics_of(self.lens, noisy)
        return Sights(flange, poses, sights.in_hand, optics)


def propose_poses(
    folder: HandEyeFolder, count: int, box: Box | None, cone: float
) -> tuple[np.ndarray, np.ndarray]:
    """Poses (n, 4, 4) of the flange, and the camera's deviation [m] before and after each.

    Args:
        box: of the flange's positions in the base (default: those measured, and a little beyond).
        cone: rad, between the line of sight and the board's normal.

    Raises NoUsefulPosture if the board would not be seen.
    """
    found = folder.found
    drawn = _drawn(folder, box, cone)
    each = information(found, folder.seen(drawn))
    scale = np.repeat([1.0, 1 / LEVER, 1.0, 1 / LEVER], 3)
    total = information(found, found.sights).sum(axis=0) + np.diag(scale**-2.0)
    chosen: list[int] = []
    deviations = [_deviation(total)]
    for _ in range(min(count, len(drawn))):
        spread = np.linalg.inv(total + each)[:, :6, :6]
        sizes = np.trace(spread[:, :3, :3], axis1=1, axis2=2)
        sizes += LEVER**2 * np.trace(spread[:, 3:, 3:], axis1=1, axis2=2)
        sizes[chosen] = np.inf
        chosen.append(int(sizes.argmin()))
        total = total + each[chosen[-1]]
        deviations.append(_deviation(total))
    return drawn[chosen], np.array(deviations)


def _deviation(information: np.ndarray) -> float:
    """m, of the camera's position along the worst axis."""
    return float(np.sqrt(np.linalg.eigvalsh(np.linalg.inv(information)[:3, :3])[-1]))


def _drawn(folder: HandEyeFolder, box: Box | None, cone: float) -> np.ndarray:
    """Poses (n, 4, 4) of the flange at which the board would be seen."""
    found, rng = folder.found, generator(0, "poses of a flange to measure next")
    flange, middle = found.sights.flange, folder.board.points.mean(axis=0)
    places = flange[:, :3, 3]
    box = box or Box(places.min(axis=0) - BEYOND, places.max(axis=0) + BEYOND)
    seen = found.predict(found.sights)
    centres = seen[:, :3, :3] @ middle + seen[:, :3, 3]
    nearest, farthest = np.quantile(np.linalg.norm(centres, axis=1), (0, 1))
    # the board before the camera: its middle on a ray, its normal within the cone about that
    focal = folder.lens.matrix[[0, 1], [0, 1]]
    rays = np.ones((TRIED, 3))
    rays[:, :2] = rng.uniform(-0.4, 0.4, (TRIED, 2)) * folder.lens.size / focal
    tilt = cone * np.sqrt(rng.uniform(0, 1, TRIED))
    about = rng.uniform(0, 2 * np.pi, TRIED)
    tilts = np.stack([tilt * np.cos(about), tilt * np.sin(about), np.zeros(TRIED)], axis=1)
    turns = Rotation.from_rotvec(tilts)
    turns *= Rotation.from_rotvec(rng.uniform(-np.pi, np.pi, TRIED)[:, None] * [0, 0, 1])
    boards = np.tile(np.eye(4), (TRIED, 1, 1))
    boards[:, :3, :3] = turns.as_matrix()
    lengths = rng.uniform(nearest, farthest, TRIED) / np.linalg.norm(rays, axis=1)
    boards[:, :3, 3] = lengths[:, None] * rays - boards[:, :3, :3] @ middle
    along = np.sum(boards[:, :3, 2] * rays, axis=1) / np.linalg.norm(rays, axis=1)
    boards = boards[along >= np.cos(cone)]
    between = found.camera @ boards @ np.linalg.inv(found.board)
    drawn = np.linalg.inv(between) if found.sights.in_hand else between
    if (turned := found.sights.axes)[0][1] < ONE_AXIS:  # it turns about this axis alone
        axis = turned[1][0]
        angles = rng.uniform(-np.pi, np.pi, len(drawn))[:, None] * axis
        drawn[:, :3, :3] = Rotation.from_rotvec(angles).as_matrix() @ flange[0, :3, :3]
    drawn = drawn[((drawn[:, :3, 3] >= box.low) & (drawn[:, :3, 3] <= box.high)).all(axis=1)]
    shown = found.predict(replace(found.sights, flange=drawn[: 10 * DRAWN]))
    _, visible = predicted_views(folder.board, folder.lens, shown, False)
    if not visible.any():
        raise NoUsefulPosture("the board would not be seen from any pose in the box and cone")
    return drawn[: 10 * DRAWN][visible][:DRAWN]
