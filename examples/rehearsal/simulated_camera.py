"""A camera before an arm in MuJoCo: a station whose measurements are pictures of a board."""

from collections.abc import Mapping
from os import PathLike
from pathlib import Path

import cv2
import mujoco
import numpy as np
from simulated_arm import Gears, PhysicsStation, placed

from recalib.damaged.damage import DamagedArm
from recalib.vision import Board, Lens, Unusable, find_corners

FOCAL = 1100.0  # px, of a lens without distortion
DETAIL = 20  # px of the texture to a module of the board
BLACK, WHITE = 20, 235
MARGIN, THIN = 0.02, 0.0005  # m of white about the board; half the thickness of a sheet
FINE = 2  # rays to a side of a pixel
NOISE = 1.5  # of 255
UPWARDS = np.diag([1.0, -1.0, -1.0, 1.0])  # MuJoCo's cameras and textures have y up, ours down


class PicturedStation(PhysicsStation):
    """An arm in MuJoCo with a board on its tool and a camera beside it.

    Args:
        damaged, gears, seed: see `PhysicsStation`.
        camera: its pose (4, 4) in the arm's base [m]; z goes into the picture.
        place: the pose (4, 4) of the board in the tool [m].
        board: one that is printable.
        folder: into which pictures go.
        size: of a picture, width and height [px].
    """

    def __init__(
        self,
        damaged: DamagedArm,
        camera: np.ndarray,
        place: np.ndarray,
        board: Board,
        folder: str | PathLike[str],
        gears: Gears | None = None,
        size: tuple[int, int] = (1280, 960),
        seed: int = 0,
    ):
        self._board, self._folder = board, Path(folder)
        self._folder.mkdir(parents=True, exist_ok=True)
        self._taken = len([*self._folder.glob("*.png")])  # earlier pictures stay
        x, y = (side / 2 - 0.5 for side in size)
        matrix = np.array([[FOCAL, 0, x], [0, FOCAL, y], [0, 0, 1]])
        self.lens = Lens(size, matrix, np.zeros(4))
        self._camera, self._place = camera, place
        super().__init__(damaged, gears, instrument=camera, target=place, seed=seed)
        width, height = (FINE * side for side in size)
        self._renderer = mujoco.Renderer(self._model, height, width)

    def _scene(self, spec: mujoco.MjSpec) -> mujoco.MjSpec:
        """The arm with a sheet of paper on its tool, the board on that, and the camera."""
        (width, height), visual = self.lens.size, spec.visual
        visual.global_.offwidth, visual.global_.offheight = FINE * width, FINE * height
        visual.headlight.ambient, visual.headlight.specular = [0.5] * 3, [0.0] * 3
        opening = np.degrees(2 * np.arctan(height / 2 / self.lens.matrix[0, 0]))
        spec.worldbody.add_camera(name="camera", fovy=opening, **placed(self._camera @ UPWARDS))
        modules = np.where(self._board.modules, BLACK, WHITE).astype(np.uint8)
        picture = np.kron(modules, np.ones((DETAIL, DETAIL), np.uint8))
        rows, columns = picture.shape
        kind, role = mujoco.mjtTexture.mjTEXTURE_2D, mujoco.mjtTextureRole.mjTEXROLE_RGB
        texture = spec.add_texture(name="board", type=kind, height=rows, width=columns, nchannel=3)
        texture.data = np.repeat(picture[..., None], 3, axis=-1).tobytes()
        spec.add_material(name="board").textures[role] = "board"
        arm, sides = self._damaged.arm, self._board.size / 2
        tool = arm.end.placement.homogeneous
        for depth, size, color in (
            (THIN, sides, {"material": "board"}),
            (2 * THIN, sides + MARGIN, {"rgba": [WHITE / 255] * 3 + [1]}),
        ):
            middle = np.eye(4)
            middle[:3, 3] = *sides, depth
            spec.bodies[-1].add_geom(
                type=mujoco.mjtGeom.mjGEOM_BOX,
                size=[*size, THIN],
                contype=0,
                conaffinity=0,
                mass=0,
                **color,
                **placed(tool @ self._place @ middle @ UPWARDS),
            )
        return spec

    def picture(self) -> np.ndarray:
        """What the camera sees now: (height, width) grey."""
        self._renderer.update_scene(self._data, camera="camera")
        fine = cv2.cvtColor(self._renderer.render(), cv2.COLOR_RGB2GRAY)
        grey = cv2.resize(fine, self.lens.size, interpolation=cv2.INTER_AREA).astype(float)
        grey += NOISE * self._rng.standard_normal(grey.shape)
        picture: np.ndarray = np.clip(grey, 0, 255).astype(np.uint8)
        return picture

    def measure(self) -> Mapping[str, float | str] | None:
        """The path of a picture; None where it does not show the board."""
        picture = self.picture()
        try:
            find_corners(self._board, picture)
        except Unusable:
            return None
        path = self._folder / f"{self._taken:03}.png"
        cv2.imwrite(str(path), picture)
        self._taken += 1
        return {"picture": str(path)}

    def close(self) -> None:
        """Free the renderer, in the thread that made it; see `Station`."""
        self._renderer.close()
