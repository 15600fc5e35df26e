"""A lens: how directions become pixels. Read from ROS' camera_info or OpenCV's YAML."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from os import PathLike

import numpy as np
import yaml

from recalib.errors import InvalidFile
from recalib.files.storage import read_file

MOST = 100_000  # bytes of a file
MODELS = {"plumb_bob": 5, "rational_polynomial": 8}  # numbers of distortion
# As files of a calibration have them, and messages: `ros2 topic echo --once .../camera_info`.
MATRICES = "camera_matrix", "k", "K"
DISTORTIONS = "distortion_coefficients", "dist_coeffs", "distCoeffs", "d", "D"
OF_OPENCV = re.compile(r"!!opencv-[\w-]+")  # a tag, which other readers do not know
SIZES = ("image_width", "image_height"), ("width", "height")


@dataclass(frozen=True)
class Lens:
    """A pinhole with distortion, as OpenCV has it.

    Attributes:
        size: of a picture, width and height [px].
        matrix: (3, 3) px.
        distortion: (5,) or (8,) k1, k2, p1, p2, k3, ...
    """

    size: tuple[int, int]
    matrix: np.ndarray
    distortion: np.ndarray

    def as_ros(self) -> str:
        """ROS' camera_info."""
        (fx, _, cx), (_, fy, cy) = self.matrix[:2]
        model = {count: name for name, count in MODELS.items()}[len(self.distortion)]
        parts = {
            MATRICES[0]: (3, 3, self.matrix.ravel()),
            DISTORTIONS[0]: (1, len(self.distortion), self.distortion),
            "rectification_matrix": (3, 3, np.eye(3).ravel()),
            "projection_matrix": (3, 4, np.array([fx, 0, cx, 0, 0, fy, cy, 0, 0, 0, 1, 0])),
        }
        lines = [f"image_width: {self.size[0]}", f"image_height: {self.size[1]}"]
        lines += ["camera_name: camera", f"distortion_model: {model}"]
        for name, (rows, columns, numbers) in parts.items():
            data = ", ".join(f"{number:.12g}" for number in numbers)
            lines += [f"{name}:", f"  rows: {rows}", f"  cols: {columns}", f"  data: [{data}]"]
        return "\n".join([*lines, ""])


def read_lens(path: str | PathLike[str]) -> Lens:
    """The lens in the YAML at `path`. Raises InvalidFile."""
    content = read_file(path, MOST)
    try:
        lines = content.decode("utf-8").splitlines()
        text = "\n".join(line for line in lines if not line.startswith(("%", "---")))
        tree = yaml.safe_load(OF_OPENCV.sub("", text))
    except (ValueError, RecursionError, yaml.YAMLError):
        tree = None
    if not isinstance(tree, dict):
        raise InvalidFile(path, "it is no YAML of OpenCV or ROS")
    if (model := tree.get("distortion_model", "plumb_bob")) not in tuple(MODELS):
        valid = " or ".join(MODELS)
        raise InvalidFile(path, f"distortion_model is {model!r}; expected: {valid}")
    matrix, distortion = (_numbers(tree, names) for names in (MATRICES, DISTORTIONS))
    sides = next((names for names in SIZES if tree.keys() >= {*names}), SIZES[0])
    size = np.concatenate([_numbers(tree, [side]) for side in sides])
    if len(matrix) != 9 or not np.isfinite(matrix).all() or min(matrix[0], matrix[4]) <= 0:
        raise InvalidFile(path, f"{MATRICES[0]} has no 9 numbers with focal lengths above zero")
    if len(distortion) not in (4, *MODELS.values()) or not np.isfinite(distortion).all():
        raise InvalidFile(path, f"{DISTORTIONS[0]} has no 4, 5 or 8 numbers")
    if len(size) != 2 or not ((size > 0) & (size < MOST) & (size % 1 == 0)).all():
        raise InvalidFile(path, f"{' and '.join(sides)} are no numbers of pixels")
    width, height = size.astype(int).tolist()
    padded = np.append(distortion, [0.0]) if len(distortion) == 4 else distortion
    return Lens((width, height), matrix.reshape(3, 3), padded)


def _numbers(tree: Mapping[str, object], names: Sequence[str]) -> np.ndarray:
    """The numbers (n,) of a matrix of one of these names; none where it has other things."""
    found = next((tree[name] for name in names if name in tree), ())
    try:
        return np.asarray(found["data"] if isinstance(found, dict) else found, float).ravel()
    except (KeyError, TypeError, ValueError):
        return np.zeros(0)
