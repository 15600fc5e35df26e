"""Lenses: camera intrinsics and distortion, in the files of ROS, OpenCV, Kalibr and RealSense."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from os import PathLike
from typing import Any

import numpy as np
import yaml

from recalib.errors import InvalidFile
from recalib.files.storage import read_file

MOST = 100_000  # bytes in a file
FISHEYE = "equidistant"  # ROS's name for OpenCV's fisheye
MODELS = {"plumb_bob": 5, "rational_polynomial": 8, FISHEYE: 4}  # distortion numbers in a file
# The keys in calibration files and in messages (`ros2 topic echo --once .../camera_info`).
MATRICES = "camera_matrix", "k", "K"
DISTORTIONS = "distortion_coefficients", "dist_coeffs", "distCoeffs", "d", "D"
OF_OPENCV = re.compile(r"!!opencv-[\w-]+")  # a tag that other YAML readers do not know
SIZES = ("image_width", "image_height"), ("width", "height")
# Models of Kalibr and RealSense. RealSense's inverse model is valid only if all coefficients are 0.
OTHERS = {"radtan": "plumb_bob", FISHEYE: FISHEYE, "none": "plumb_bob"}
OTHERS |= {"brown conrady": "plumb_bob", "kannala brandt4": FISHEYE}
REALSENSE = "fx", "fy", "ppx", "ppy"
# Limits on focal lengths over the larger side of a picture: from a fisheye to a telescope.
LONGEST = 0.05, 50.0


@dataclass(frozen=True)
class Lens:
    """OpenCV's pinhole with distortion, or its fisheye.

    Attributes:
        size: the width and height of a picture [px].
        matrix: (3, 3) px, the camera matrix.
        distortion: (4,), (5,) or (8,) k1, k2, p1, p2, k3, ...; for a fisheye, k1 to k4.
        fisheye: whether the model is a fisheye.
    """

    size: tuple[int, int]
    matrix: np.ndarray
    distortion: np.ndarray
    fisheye: bool = False

    @property
    def model(self) -> str:
        """ROS's name of the model."""
        if self.fisheye:
            return FISHEYE
        return "plumb_bob" if len(self.distortion) <= MODELS["plumb_bob"] else "rational_polynomial"

    def as_ros(self) -> str:
        """The lens as the YAML of ROS's camera_info."""
        (fx, _, cx), (_, fy, cy) = self.matrix[:2]
        distortion = np.zeros(MODELS[self.model])
        distortion[: len(self.distortion)] = self.distortion
        parts = {
            MATRICES[0]: (3, 3, self.matrix.ravel()),
            DISTORTIONS[0]: (1, len(distortion), distortion),
            "rectification_matrix": (3, 3, np.eye(3).ravel()),
            "projection_matrix": (3, 4, np.array([fx, 0, cx, 0, 0, fy, cy, 0, 0, 0, 1, 0])),
        }
        lines = [f"image_width: {self.size[0]}", f"image_height: {self.size[1]}"]
        lines += ["camera_name: camera", f"distortion_model: {self.model}"]
        for name, (rows, columns, numbers) in parts.items():
            data = ", ".join(f"{number:.12g}" for number in numbers)
            lines += [f"{name}:", f"  rows: {rows}", f"  cols: {columns}", f"  data: [{data}]"]
        return "\n".join([*lines, ""])


def read_lens(path: str | PathLike[str]) -> Lens:
    """The lens in the YAML or JSON at `path`, without trailing coefficients that are zero.

    Raises InvalidFile.
    """
    content = read_file(path, MOST)
    try:
        lines = content.decode("utf-8").splitlines()
        text = "\n".join(line for line in lines if not line.startswith(("%", "---")))
        tree = yaml.safe_load(OF_OPENCV.sub("", text).replace("\t", " "))
    except (ValueError, RecursionError, yaml.YAMLError):
        tree = None
    if not isinstance(tree, dict):
        raise InvalidFile(path, "it is not a YAML file of OpenCV, ROS, Kalibr or RealSense")
    try:
        tree = _as_ros(tree)
    except (KeyError, TypeError, ValueError) as error:
        raise InvalidFile(path, f"it is not a lens: {error}") from None
    matrix, distortion = (_numbers(tree, names) for names in (MATRICES, DISTORTIONS))
    sides = next((names for names in SIZES if tree.keys() >= {*names}), SIZES[0])
    size = np.concatenate([_numbers(tree, [side]) for side in sides])
    if len(size) != 2 or not ((size > 0) & (size < MOST) & (size % 1 == 0)).all():
        raise InvalidFile(path, f"{' and '.join(sides)} are not numbers of pixels")
    width, height = size.astype(int).tolist()
    if len(matrix) != 9 or not np.isfinite(matrix).all():
        raise InvalidFile(path, f"{MATRICES[0]} needs 9 numbers")
    fx, _, cx, _, fy, cy, *_ = matrix
    if not np.array_equal(matrix, [fx, 0, cx, 0, fy, cy, 0, 0, 1]):
        raise InvalidFile(
            path, f"{MATRICES[0]} is {matrix.tolist()}; expected: fx 0 cx 0 fy cy 0 0 1"
        )
    least, most = (share * max(width, height) for share in LONGEST)
    if not least <= min(fx, fy) <= max(fx, fy) <= most:
        valid = f"{least:.0f} to {most:.0f} px for pictures of {width} x {height}"
        raise InvalidFile(path, f"its focal lengths are {fx:g} and {fy:g}; expected: {valid}")
    default = "rational_polynomial" if len(distortion) == 8 else "plumb_bob"
    if (model := tree.get("distortion_model", default)) not in tuple(MODELS):
        valid = ", ".join(MODELS)
        raise InvalidFile(path, f"distortion_model is {model!r}; expected: one of {valid}")
    counts = (4, 5) if model == "plumb_bob" else (MODELS[model],)
    if len(distortion) not in counts or not np.isfinite(distortion).all():
        valid = " or ".join(map(str, counts))
        raise InvalidFile(path, f"{DISTORTIONS[0]} needs {valid} numbers for {model}")
    if model != FISHEYE:
        count = next(n for n in (4, 5, 8) if not distortion[n:].any())
        distortion = distortion[:count]
    return Lens((width, height), matrix.reshape(3, 3), distortion, model == FISHEYE)


def _as_ros(tree: Mapping[str, Any]) -> Mapping[str, Any]:
    """The content of a file of Kalibr or RealSense with ROS's keys; other content unchanged.

    Raises KeyError, TypeError, ValueError.
    """
    cameras = [camera for name, camera in tree.items() if re.fullmatch(r"cam\d+", str(name))]
    if len(cameras) > 1:
        raise ValueError(f"it has {len(cameras)} cameras; try: one of them in a file of its own")
    given = {str(name).lower(): value for name, value in (*cameras, tree)[0].items()}
    if "camera_model" in given:
        if given["camera_model"] != "pinhole":
            raise ValueError(f"camera_model is {given['camera_model']!r}; expected: pinhole")
        size, focal, model = given["resolution"], given["intrinsics"], given["distortion_model"]
        coefficients = given.get("distortion_coeffs") or [0.0] * 4
    elif given.keys() >= {*REALSENSE}:
        size, focal = ([given[key] for key in keys] for keys in (SIZES[1], REALSENSE))
        coefficients, model = given["coeffs"], given.get("model", given.get("distortion"))
        coefficients = coefficients.split() if isinstance(coefficients, str) else coefficients
        coefficients = [float(number) for number in coefficients]
        model = model if any(coefficients) else "none"
    else:
        return tree
    name = str(model).lower().replace("_", " ").removeprefix("distortion.")
    if name not in OTHERS:
        raise ValueError(f"its model is {name!r}; expected: {', '.join(OTHERS)}, or all zero")
    fx, fy, cx, cy = focal
    named = OTHERS[name], [fx, 0, cx, 0, fy, cy, 0, 0, 1], coefficients[: MODELS[OTHERS[name]]]
    keys = "distortion_model", MATRICES[0], DISTORTIONS[0]
    return dict(zip((*SIZES[0], *keys), (*size, *named), strict=True))


def _numbers(tree: Mapping[str, object], names: Sequence[str]) -> np.ndarray:
    """The numbers (n,) of the matrix with one of these names; empty if they are not numbers."""
    found = next((tree[name] for name in names if name in tree), ())
    try:
        return np.asarray(found["data"] if isinstance(found, dict) else found, float).ravel()
    except (KeyError, TypeError, ValueError):
        return np.zeros(0)
