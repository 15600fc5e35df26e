"""Files of poses: their text, or rows of cells from YAML, JSON, exports, and a file each."""

import re
from collections.abc import Sequence
from contextlib import suppress
from glob import glob
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from scipy.spatial.transform import RigidTransform, Rotation

from recalib.errors import InvalidFile
from recalib.files.outputs import AnyPath
from recalib.files.storage import path_of, read_file
from recalib.laboratory.tables.records import cells_of, in_order, poses_in
from recalib.laboratory.tables.table import MOST, number_in
from recalib.vision.lenses import OF_OPENCV

MOST_TREE = 2_000_000  # bytes of YAML or JSON
TREES = ".json", ".yaml", ".yml", ".xml"
NO_POSES = "it has no poses; expected: lists of 12 or 16 numbers, or 'translation' and 'rotation'"
NO_POSES += "; try: --convention"
_COMMENT = re.compile(r"(^[ \t]*(#|%|//)|[ \t]+#).*", re.MULTILINE)
_HEADER = re.compile(r"\A[#%]\s*(?=([^\n,]*,){6})")  # headings in a comment
_NUMBER = r"([-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?)"
_HALCON = re.compile(rf"\s*f\s+([02])\s+r{(three := 3 * (' ' + _NUMBER))}\s+t{three}\s*")
_AXES = {"0": "XYZ", "2": "xyz"}  # of HALCON's types of poses


def read_text(path: AnyPath, targets: bool, headings: Sequence[str]) -> tuple[str, list[list[str]]]:
    """The text of a file, and its poses if it is no table; or those in files with one each.

    A pattern stands for files in the order of the numbers in their names. See `poses_in`.
    """
    files, text, rows, trees = [path_of(path)], "", list[list[str]](), list[Any]()
    if files[0].is_dir():
        raise InvalidFile(path, "it is a folder; try: a pattern in quotes, such as 'poses/*.yaml'")
    if each := not files[0].exists() and "*" in str(path):
        files = [*map(Path, sorted(glob(str(path)), key=in_order))]
        if not files:
            raise InvalidFile(path, "no file has such a name")
    for file in files:
        if b"\0" in (content := read_file(file, MOST)):
            valid = "text, as by numpy.savetxt(FILE, poses.reshape(-1, 16))"
            raise InvalidFile(file, f"it is binary; expected: {valid}")
        text = _COMMENT.sub("", _HEADER.sub("", content.decode("utf-8-sig", "replace")))
        documents: list[Any] = []
        if len(text) < MOST_TREE and "&" not in text:  # anchors can be repeated without an end
            tree = re.sub(r"\}\s*\n\s*\{", "}\n---\n{", OF_OPENCV.sub("", text).replace("\t", " "))
            with suppress(ValueError, TypeError, KeyError, RecursionError, yaml.YAMLError):
                documents = [*yaml.safe_load_all(tree)]
        if not (numbers := cells_of(text)):
            raise InvalidFile(file, "it is empty")
        trees += documents
        rows += (labelled := _labelled(text, headings)) or [numbers] * each
        plain = labelled or np.isfinite([*map(number_in, numbers)]).all()
        if not (plain or poses_in(documents, True, headings)) and file.suffix in TREES:
            raise InvalidFile(file, NO_POSES)
    rows = poses_in(trees, targets, headings) or rows
    if not rows and files[0].suffix in TREES:
        raise InvalidFile(path, NO_POSES)
    return text, rows


def _labelled(text: str, headings: Sequence[str]) -> list[list[str]]:
    """Poses whose numbers follow their names, as in `X 1.5, Y -2`, or HALCON's; none without."""
    if found := _HALCON.fullmatch(text):
        turn, place = np.array(found.groups()[1:], float).reshape(2, 3)
        rotation = Rotation.from_euler(_AXES[found[1]], turn, degrees=True)
        pose = RigidTransform.from_components(place, rotation).as_matrix()
        return [[*map(repr, pose[:3].ravel().tolist())]]
    before = (rf"(?i)(?<![\w.]){name}[\s:=]+{_NUMBER}" for name in (*"xyz", *headings))
    columns = [re.findall(each, text) for each in before]
    same = headings and len({*map(len, columns)}) == 1
    return [[*row] for row in zip(*columns, strict=True)] if same else []
