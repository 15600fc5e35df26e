"""A real arm before a camera: corners as a lens maps them, and whole pictures of the board."""

from dataclasses import dataclass
from functools import cached_property

import cv2
import numpy as np

from recalib import load_arm
from recalib.vision.boards import Board, printable
from recalib.vision.detection import Corners
from recalib.vision.lenses import Lens
from tests.identification.real import Real

BOARD = printable(7, 5, 0.036)
LENS = Lens(
    (1280, 960),
    np.array([[1105.0, 0, 652], [0, 1102, 470], [0, 0, 1]]),
    np.array([-0.21, 0.08, 4e-4, -3e-4]),
)
BLACK, GREY, WHITE = 20, 110, 235
DETAIL, FINE, PAPER = 12, 2, 0.03  # texture px a module; rays a pixel; m of white about the board


def frame(turn: list[float], place: list[float]) -> np.ndarray:
    """(4, 4) m from a rotation vector [rad]."""
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = cv2.Rodrigues(np.array(turn, dtype=float))[0], place
    return pose


@dataclass
class Cell:
    """A Panda off as in docs/peers.md, a camera and a board, one on the hand, one beside the arm.

    Args:
        seed: of the arm's errors, of frames and of postures.
        in_hand: whether the camera is on the hand.
    """

    seed: int
    in_hand: bool = False
    board: Board = BOARD
    lens: Lens = LENS

    def __post_init__(self):
        self.arm = load_arm("panda.urdf", "panda_link8")
        self.real = Real(self.arm, self.seed)
        self.random = np.random.default_rng([self.seed, 2])
        turn, place = (scale * self.random.uniform(-1, 1, 3) for scale in (0.2, 0.05))
        off = frame(turn, place)
        middle = frame([0, 0, 0], [*-self.board.size / 2, 0])
        if self.in_hand:  # the board lies on the table, the camera looks along the flange
            self.eye = frame([0, 0, 0.3], [0.06, 0.02, 0.05]) @ off  # in the tool
            self.sheet = frame([np.pi, 0, 0], [0.5, 0, 0.0]) @ off @ middle  # in the base
        else:  # the camera looks back at the arm, the board is on the flange
            self.eye = frame([0, 0, np.pi / 2], [1.35, 0, 0.75]) @ frame([-2.0, 0, 0], [0] * 3)
            self.eye = self.eye @ off
            self.sheet = frame([0, 0, 0], [0, 0, 0.05]) @ off @ middle

    def tool(self, joints: np.ndarray) -> np.ndarray:
        """Poses (n, 4, 4) [m] of the real arm's tool in its base."""
        real = self.real
        poses = np.linalg.inv(real.base) @ real.poses(joints, noise=(0, 0))
        return poses @ np.linalg.inv(real.targets[0])

    def board_poses(self, joints: np.ndarray) -> np.ndarray:
        """Poses (n, 4, 4) [m] of the board in the camera, in the real arm."""
        tool = self.tool(joints)
        if self.in_hand:
            return np.linalg.inv(tool @ self.eye) @ self.sheet
        return np.linalg.inv(self.eye) @ tool @ self.sheet

    def project(self, pose: np.ndarray) -> np.ndarray:
        """Corners (c, 2) [px] of the board at a pose."""
        turn, points = cv2.Rodrigues(pose[:3, :3])[0], self.board.points
        return cv2.projectPoints(points, turn, pose[:3, 3], self.lens.matrix, self.lens.distortion)[
            0
        ].reshape(-1, 2)

    def view(self, pose: np.ndarray, noise: float = 0.0, random=None) -> Corners:
        """All corners of the board at a pose, off by some noise [px]."""
        pixels = self.project(pose)
        pixels += noise * (random or self.random).standard_normal(pixels.shape)
        return Corners(np.arange(len(pixels)), pixels, 1.0)

    def postures(self, count: int) -> np.ndarray:
        """Postures (count, 7) [rad] in which the whole board is in the picture, turned to it."""
        middle = np.array([0, 0.1, 0, -1.9, 0, 2.0 if self.in_hand else 2.9, 0.8])
        wide = np.array([0.7, 0.5, 0.7, 0.6, 0.8, 0.7, 1.4])
        low, high = (getattr(self.arm.model, f"{end}PositionLimit") for end in ("lower", "upper"))
        found = []
        while len(found) < count:
            joints = middle + wide * self.random.uniform(-1, 1, (400, 7))
            joints = joints[((joints > low) & (joints < high)).all(axis=1)]
            for its, pose in zip(joints, self.board_poses(joints), strict=True):
                corners = pose[:3, :3] @ self.board.points.T + pose[:3, 3:]
                facing = -(pose[:3, 2] @ pose[:3, 3]) / np.linalg.norm(pose[:3, 3])
                near = corners[2].min() > 0.3 and corners[2].max() < 1.4
                if near and facing < -0.55:
                    pixels = self.project(pose)
                    if (pixels > 30).all() and (pixels < np.subtract(self.lens.size, 30)).all():
                        found.append(its)
        return np.array(found[:count])

    @cached_property
    def _texture(self) -> np.ndarray:
        modules = np.where(self.board.modules, BLACK, WHITE).astype(np.uint8)
        return np.kron(modules, np.ones((DETAIL, DETAIL), np.uint8))

    def picture(self, pose: np.ndarray, blur: float = 0.7, noise: float = 2.0) -> np.ndarray:
        """A picture (height, width) of the board at a pose, with uneven light.

        Args:
            blur: px, standard deviation.
            noise: of 255.
        """
        left, top, right, bottom = self._about(pose)
        x, y = (
            (np.arange(FINE * (end - at)) + 0.5) / FINE - 0.5 + at
            for at, end in ((left, right), (top, bottom))
        )
        grid = np.stack(np.meshgrid(x, y), axis=-1)
        rays = cv2.undistortPoints(grid.reshape(-1, 1, 2), self.lens.matrix, self.lens.distortion)
        plane = np.linalg.inv(pose[:3, [0, 1, 3]])  # of a ray where the board is
        places = cv2.perspectiveTransform(rays, plane).reshape(grid.shape)
        scale = self._texture.shape[::-1] / self.board.size
        lookup = (places * scale - 0.5).astype(np.float32)
        fine = cv2.remap(self._texture, lookup, None, cv2.INTER_LINEAR, borderValue=GREY)
        paper = ((places > -PAPER) & (places < self.board.size + PAPER)).all(axis=-1)
        inside = ((places > 0) & (places < self.board.size)).all(axis=-1)
        fine[paper & ~inside] = WHITE
        coarse = cv2.resize(fine, (right - left, bottom - top), interpolation=cv2.INTER_AREA)
        picture = np.full(self.lens.size[::-1], float(GREY))
        picture[top:bottom, left:right] = coarse
        picture = cv2.GaussianBlur(picture, (0, 0), blur) * np.linspace(0.7, 1.0, len(picture[0]))
        picture += noise * self.random.standard_normal(picture.shape)
        return np.clip(picture, 0, 255).astype(np.uint8)

    def _about(self, pose: np.ndarray) -> np.ndarray:
        """The part of a picture [px] with the board in it: left, top, right, bottom."""
        pixels, margin = self.project(pose), 150
        low = np.clip(pixels.min(axis=0) - margin, 0, self.lens.size)
        high = np.clip(pixels.max(axis=0) + margin, 0, self.lens.size)
        return np.concatenate([low, high]).astype(int)
