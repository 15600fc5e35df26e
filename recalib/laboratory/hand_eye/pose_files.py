"""Poses in YAML and JSON of other programs, and in a file each, as rows of numbers."""

import re
from collections.abc import Iterator
from contextlib import suppress
from itertools import chain
from typing import Any

import numpy as np
import yaml
from scipy.spatial.transform import RigidTransform, Rotation

from recalib.errors import InvalidFile
from recalib.files.outputs import AnyPath
from recalib.files.storage import path_of, read_file
from recalib.laboratory.tables.table import MOST, number_in
from recalib.vision.lenses import OF_OPENCV

MOST_TREE = 2_000_000  # bytes of YAML or JSON
COUNTS = 6, 7, 12, 16  # numbers of a pose
_COMMENT = re.compile(r"^\s*(#|%|//|---).*\n?", re.MULTILINE)
_OF_TARGETS = re.compile("object|target|track|optical|marker|board|cam|eye")  # in names of samples
_ROS = ("translation", "rotation"), ("position", "orientation")


def read_text(path: AnyPath, targets: bool) -> tuple[str, list[list[str]]]:
    """The text of a file, and its poses if it is YAML or JSON; or those in files with one each.

    A pattern stands for files in the order of the numbers in their names. If samples have two
    poses, those of the target are read if `targets`, else the flange's.
    """
    files, text, rows = [path_of(path)], "", []
    if files[0].is_dir():
        raise InvalidFile(path, "it is a folder; try: a pattern in quotes, such as 'poses/*.yaml'")
    if each := not files[0].exists() and "*" in str(path):
        found = files[0].parent.glob(files[0].name)
        files = sorted(found, key=lambda file: [*map(int, re.findall(r"\d+", file.name))])
    for file in files:
        if b"\0" in (content := read_file(file, MOST)):
            valid = "text, as by numpy.savetxt(FILE, poses.reshape(-1, 16))"
            raise InvalidFile(file, f"it is binary; expected: {valid}")
        text = _COMMENT.sub("", content.decode("utf-8-sig", "replace"))
        poses: list[list[str]] = []
        if len(text) < MOST_TREE and "&" not in text:  # anchors can be repeated without an end
            with suppress(ValueError, TypeError, KeyError, RecursionError, yaml.YAMLError):
                poses = [*_poses_in(yaml.safe_load(OF_OPENCV.sub("", text)), targets)]
        rows += poses or [re.split(r"[\s,;]+", text.strip())] * each
    return text, rows


def _poses_in(tree: Any, targets: bool) -> Iterator[list[str]]:
    """The numbers of each pose in the content of a YAML or JSON file."""
    if isinstance(tree, list):
        numbers = [*map(str, _flat(tree))]
        if len(numbers) in COUNTS and np.isfinite([*map(number_in, numbers)]).all():
            yield numbers
        else:
            yield from chain(*(_poses_in(part, targets) for part in tree))
    elif isinstance(tree, dict):
        if names := next((names for names in _ROS if tree.keys() >= {*names}), None):
            place, turn = (
                [tree[name][axis] for axis in "xyzw"[: 3 + at]] for at, name in enumerate(names)
            )
            pose = RigidTransform.from_components(place, Rotation.from_quat(turn))
            yield [*map(repr, pose.as_matrix()[:3].ravel().tolist())]
        parts = {str(name).lower(): [*_poses_in(part, targets)] for name, part in tree.items()}
        ours = [parts[name] for name in parts if bool(_OF_TARGETS.search(name)) == targets]
        yield from chain(*(ours if any(ours) else parts.values()))


def _flat(tree: Any) -> list[Any]:
    return [*chain(*map(_flat, tree))] if isinstance(tree, list) else [tree]
