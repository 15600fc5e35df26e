"""A real arm before a camera: corners as a lens maps them, and whole pictures of the board."""

from dataclasses import dataclass

import cv2
import numpy as np

from recalib import load_arm
from recalib.vision import Board, Corners, Lens, printable
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


# Camera and board, each on the flange or in the base: one on the hand, which looks down at a table;
# one beside the arm, which looks back at it; one above an arm of four axes.
IN_HAND = frame([0, 0, 0.3], [0.06, 0.02, 0.05]), frame([np.pi, 0, 0], [0.5, 0, 0.0])
FIXED = (
    frame([0, 0, np.pi / 2], [1.35, 0, 0.75]) @ frame([-2.0, 0, 0], [0, 0, 0]),
    frame([0, 0, 0], [0, 0, 0.05]),
)
ABOVE = frame([np.pi, 0, 0], [0.5, 0, 1.2]), frame([np.pi, 0, 0], [0.05, 0, -0.02])


def placed(places: tuple[np.ndarray, np.ndarray], board: Board, random) -> tuple[np.ndarray, ...]:
    """Camera and board (4, 4) about these places, off by up to 0.05 m and 0.2 rad along an axis."""
    turn, place = (scale * random.uniform(-1, 1, 3) for scale in (0.2, 0.05))
    off = frame(turn, place)
    return places[0] @ off, places[1] @ off @ frame([0, 0, 0], [*-board.size / 2, 0])


def photograph(
    sheet: np.ndarray, scale: float, lens: Lens, pose: np.ndarray, random, blur: float = 0.7
) -> np.ndarray:
    """A picture (height, width) of a printed sheet in uneven light.

    Args:
        sheet: its greys, with white paper around what it shows.
        scale: px of it a metre.
        pose: of the upper left corner of what it shows, in the camera [m].
        blur: px, standard deviation.
    """
    paper, optics = round(PAPER * scale), (lens.matrix, lens.distortion)
    ends = (np.array([[0, 0], [1, 0], [0, 1], [1, 1]]) * sheet.shape[::-1] - paper) / scale
    corners, where = np.pad(ends, ((0, 0), (0, 1))), (pose[:3, :3], pose[:3, 3])
    pixels, _ = cv2.projectPoints(corners, *where, *optics)
    low = np.clip(pixels.min(axis=(0, 1)) - 50, 0, lens.size).astype(int)
    high = np.clip(pixels.max(axis=(0, 1)) + 50, 0, lens.size).astype(int)
    x, y = ((np.arange(FINE * a, FINE * b) + 0.5) / FINE - 0.5 for a, b in np.stack([low, high], 1))
    grid = np.stack(np.meshgrid(x, y), axis=-1)
    rays = cv2.undistortPoints(grid.reshape(-1, 1, 2), *optics)
    plane = np.linalg.inv(pose[:3, [0, 1, 3]])  # of a ray where the sheet is
    places = cv2.perspectiveTransform(rays, plane).reshape(grid.shape)
    lookup = (places * scale + paper - 0.5).astype(np.float32)
    fine = cv2.remap(sheet, lookup, None, cv2.INTER_LINEAR, borderValue=GREY)
    picture = np.full(lens.size[::-1], float(GREY))
    part = tuple((high - low).tolist())
    picture[low[1] : high[1], low[0] : high[0]] = cv2.resize(
        fine, part, interpolation=cv2.INTER_AREA
    )
    picture = cv2.GaussianBlur(picture, (0, 0), blur) * np.linspace(0.7, 1.0, len(picture[0]))
    picture += 2 * random.standard_normal(picture.shape)
    return np.clip(picture, 0, 255).astype(np.uint8)


def photograph_of(board: Board, lens: Lens, pose: np.ndarray, random, blur: float = 0.7):
    """A picture (height, width) of a board at a pose in the camera."""
    modules = np.where(board.modules, BLACK, WHITE).astype(np.uint8)
    printed = np.kron(modules, np.ones((DETAIL, DETAIL), np.uint8))
    scale = printed.shape[1] / board.size[0]
    sheet = np.pad(printed, round(PAPER * scale), constant_values=WHITE)
    return photograph(sheet, scale, lens, pose, random, blur)


@dataclass
class Cell:
    """A Panda off as in docs/peers.md; camera and board, one on the hand, one beside the arm."""

    seed: int  # of the arm's errors, of frames and of postures
    in_hand: bool = False  # whether the camera is on the hand
    board: Board = BOARD
    lens: Lens = LENS

    def __post_init__(self):
        self.arm = load_arm("panda.urdf", "panda_link8")
        self.real = Real(self.arm, self.seed)
        self.random = np.random.default_rng([self.seed, 2])
        where = IN_HAND if self.in_hand else FIXED
        self.eye, self.sheet = placed(where, self.board, self.random)

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
        lens, ends = self.lens, (self.board.points, pose[:3, :3], pose[:3, 3])
        return cv2.projectPoints(*ends, lens.matrix, lens.distortion)[0].reshape(-1, 2)

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
            for posture, pose in zip(joints, self.board_poses(joints), strict=True):
                corners = pose[:3, :3] @ self.board.points.T + pose[:3, 3:]
                facing = -(pose[:3, 2] @ pose[:3, 3]) / np.linalg.norm(pose[:3, 3])
                in_range = corners[2].min() > 0.3 and corners[2].max() < 1.4
                if in_range and facing < -0.55:
                    pixels = self.project(pose)
                    if (pixels > 30).all() and (pixels < np.subtract(self.lens.size, 30)).all():
                        found.append(posture)
        return np.array(found[:count])

    def picture(self, pose: np.ndarray, blur: float = 0.7) -> np.ndarray:
        """A picture (height, width) of the board at a pose."""
        return photograph_of(self.board, self.lens, pose, self.random, blur)
