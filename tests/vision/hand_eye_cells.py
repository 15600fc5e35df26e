"""Cells for hand-eye calibrations: a flange with errors, a camera and a board."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.identification.model.hand_eye_model import Sights
from recalib.laboratory.hand_eye.calibrating import seen
from recalib.laboratory.pictures.observed import Observed, Picture
from recalib.laboratory.tables.table import Table
from recalib.vision import Board, Corners, Lens, board_pose, find_lens, projected
from tests.vision.rendering import ABOVE, BOARD, FIXED, IN_HAND, LENS, frame, photograph_of, placed

NOISE = 0.15  # px


def turned(turns: np.ndarray, places: np.ndarray | None = None) -> np.ndarray:
    """Poses (n, 4, 4) [m] of rotation vectors (n, 3) [rad]."""
    poses = np.tile(np.eye(4), (len(turns), 1, 1))
    poses[:, :3, :3] = Rotation.from_rotvec(turns).as_matrix()
    poses[:, :3, 3] = 0.0 if places is None else places
    return poses


@dataclass
class HandEyeCell:
    """A camera on the hand or next to the arm."""

    seed: int
    in_hand: bool
    position: float = 5e-4  # m, standard deviation of the flange's pose along each axis
    rotation: float = np.radians(0.05)  # rad
    four_axes: bool = False  # whether the flange turns about the vertical alone
    board: Board = BOARD
    lens: Lens = LENS

    def __post_init__(self):
        self.rng = np.random.default_rng([self.seed, self.in_hand, 47])
        where = IN_HAND if self.in_hand else ABOVE if self.four_axes else FIXED
        self.camera, self.target = placed(where, self.board, self.rng)

    def flange(self, count: int) -> np.ndarray:
        """True poses (count, 4, 4) [m] of the flange, in which the whole board is seen."""
        found: list[np.ndarray] = []
        while len(found) < count:
            tilts = self.rng.normal(size=(200, 3)) * [0.4, 0.4, 0.8]
            middle = self.board.points.mean(axis=0)
            places = self.rng.uniform([-0.15, -0.1, 0.5], [0.15, 0.1, 0.9], (200, 3))
            boards = turned(tilts, places)
            boards[:, :3, 3] -= boards[:, :3, :3] @ middle
            flange = self._flange_of(boards)
            if self.four_axes:
                turns = np.zeros((200, 3))
                turns[:, 2] = self.rng.uniform(-2.5, 2.5, 200)
                flip = frame([np.pi * self.in_hand, 0, 0], [0, 0, 0])
                flange = turned(turns, flange[:, :3, 3]) @ flip
            found += [pose for pose in flange if self._sees(pose)]
        return np.array(found[:count])

    def _flange_of(self, boards: np.ndarray) -> np.ndarray:
        """Poses of the flange with the board at these poses in the camera."""
        if self.in_hand:
            return self.target @ np.linalg.inv(boards) @ np.linalg.inv(self.camera)
        return self.camera @ boards @ np.linalg.inv(self.target)

    def board_poses(self, flange: np.ndarray) -> np.ndarray:
        """Poses (..., 4, 4) [m] of the board in the camera."""
        between = np.linalg.inv(flange) if self.in_hand else flange
        return np.linalg.inv(self.camera) @ between @ self.target

    def _sees(self, flange: np.ndarray) -> bool:
        pose = self.board_poses(flange)
        ahead = self.board.points @ pose[2, :3] + pose[2, 3]
        if ahead.min() < 0.3 or pose[2, 2] < 0.5:
            return False
        pixels, _ = projected(self.board.points, self.lens, pose)
        return bool(((pixels > 20) & (pixels < np.subtract(self.lens.size, 20))).all())

    def reported(self, flange: np.ndarray) -> np.ndarray:
        """Poses (n, 4, 4) that the controller reports, off by its errors."""
        size = len(flange), 3
        off = self.rotation * self.rng.standard_normal(size)
        return flange @ turned(off, self.position * self.rng.standard_normal(size))

    def views(self, flange: np.ndarray, noise: float = NOISE) -> list[Corners]:
        """All corners in a picture at each pose, off by some noise [px]."""
        views = []
        for pose in self.board_poses(flange):
            pixels, _ = projected(self.board.points, self.lens, pose)
            pixels = pixels + noise * self.rng.standard_normal(pixels.shape)
            views.append(Corners(np.arange(len(pixels)), pixels, 1.0))
        return views

    def sights(self, count: int, height: float | None = None) -> Sights:
        """By `count` pictures and the lens from them; a given height is off by `height` [m]."""
        flange = self.flange(count)
        shown = shown_by(self, self.views(flange))
        known = None if height is None else (float(self.target[2, 3]) + height, 1e-4)
        return seen(shown, self.reported(flange), known)

    def draw(self, pose: np.ndarray) -> np.ndarray:
        """A picture (height, width) of the board at a pose in the camera."""
        return photograph_of(self.board, self.lens, pose, self.rng)


def shown_by(cell: HandEyeCell, views: list[Corners]) -> Observed:
    """What `observe` finds in pictures with these corners."""
    lens = find_lens([(cell.board, view) for view in views], cell.lens.size)
    pictures = [
        Picture(
            row, f"{row}.png", corners=view, error=0.2, pose=board_pose(cell.board, lens.lens, view)
        )
        for row, view in enumerate(views, 1)
    ]
    return Observed(Table(Path(), {}, {}, {}), cell.board, lens, None, cell.in_hand, pictures, [])
