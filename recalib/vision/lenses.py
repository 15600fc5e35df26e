"""A lens: how directions become pixels. Read from ROS' camera_info or OpenCV's YAML."""

from dataclasses import dataclass
from os import PathLike
from typing import Any

import cv2
import numpy as np

from recalib.errors import InvalidFile
from recalib.files.storage import read_file

MOST = 100_000  # bytes of a file
MODELS = {"plumb_bob": 5, "rational_polynomial": 8}  # numbers of distortion
MATRIX = "camera_matrix"
DISTORTIONS = "distortion_coefficients", "dist_coeffs", "distCoeffs"
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
            MATRIX: (3, 3, self.matrix.ravel()),
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
        flags = cv2.FILE_STORAGE_READ | cv2.FILE_STORAGE_MEMORY
        # OpenCV reads what ROS writes, too, below its own first line
        tree = cv2.FileStorage(f"%YAML:1.0\n---\n{text}\n", flags)
    except (ValueError, SystemError, cv2.error):
        raise InvalidFile(path, "it is no YAML of OpenCV or ROS") from None
    model = tree.getNode("distortion_model")
    if not model.empty() and model.string() not in MODELS:
        valid = " or ".join(MODELS)
        raise InvalidFile(path, f"distortion_model is {model.string()!r}; expected: {valid}")
    named = (_numbers(tree.getNode(name)) for name in DISTORTIONS)
    distortion = next(filter(len, named), np.zeros(0))
    matrix = _numbers(tree.getNode(MATRIX))
    sizes = [[tree.getNode(name) for name in names] for names in SIZES]
    size = next((its for its in sizes if not any(node.empty() for node in its)), None)
    if len(matrix) != 9 or not np.isfinite(matrix).all() or min(matrix[0], matrix[4]) <= 0:
        raise InvalidFile(path, f"{MATRIX} has no 9 numbers with focal lengths above zero")
    if len(distortion) not in (4, *MODELS.values()) or not np.isfinite(distortion).all():
        raise InvalidFile(path, f"{DISTORTIONS[0]} has no 4, 5 or 8 numbers")
    if size is None or not all(0 < node.real() < MOST for node in size):  # a text is huge
        raise InvalidFile(path, "image_width and image_height are no numbers of pixels")
    width, height = (int(node.real()) for node in size)
    padded = np.append(distortion, [0.0]) if len(distortion) == 4 else distortion
    return Lens((width, height), matrix.reshape(3, 3), padded)


def _numbers(node: Any) -> np.ndarray:
    """The numbers of a matrix, or none."""
    data = node.getNode("data") if node.isMap() else node
    return np.array([data.at(index).real() for index in range(data.size() if data.isSeq() else 0)])
