"""Poses in YAML and JSON of other programs, and in a file each, as rows of cells."""

import re
from collections.abc import Iterator, Sequence
from contextlib import suppress
from glob import glob
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from scipy.spatial.transform import Rotation

from recalib.errors import InvalidFile
from recalib.files.outputs import AnyPath
from recalib.files.storage import path_of, read_file
from recalib.laboratory.tables.table import MOST, number_in
from recalib.vision.lenses import OF_OPENCV

MOST_TREE = 2_000_000  # bytes of YAML or JSON
COUNTS = 6, 7, 12, 16  # numbers of a pose
BETWEEN, BRACKETS = re.compile(r"[\s,;\"']+"), re.compile(r"\bp(?=\[)|[\[\](){}]")
NAMED = re.compile(r"\.(png|jpe?g|bmp|tiff?|pgm)$", re.IGNORECASE)  # a picture
_COMMENT = re.compile(r"^[ \t]*(#|%|//).*\n?", re.MULTILINE)
_HEADER = re.compile(r"\A[#%]\s*(?=([^\n,]*,){6})")  # headings in a comment
# in names: of the target; of something else; of positions; of rotations, and those in radians
_OF_TARGETS = re.compile("object|target|track|optical|marker|board|cam|eye|[rt]vec|pattern|tag")
_OTHER = re.compile("joint|axis|force|torque|wrench|speed|vel|dist|coef|intrinsic|camera_mat")
_PLACE = re.compile("(?<![a-z])(t|p|pos|xyz|tvec|trans|translation|position)s?(?![a-z])(_vector)?")
_TURN = re.compile(
    "(?<![a-z])(r|q|rot|quat|quaternion|rvec|rotvec|rotation|orientation|euler|rpy)s?(?![a-z])"
    "(_(wxyz|xyzw|vector|vec|matrix))?"
)
_VECTOR = re.compile("rvec|rotvec|rotation_vec")
_STUCK = re.compile(r"(?<=[a-z])(?=[A-Z])|(?<=(?<![a-z])[tprq])(?=([xyzw]|\d\d?)$)")
_AXIS = re.compile(r"(?:(.*)[_./ \[])?([xyzw]|\d\d?)\]?")
_NUMBER = r"([-+]?[\d.]+(?:e[-+]?\d+)?)"
_HALCON = re.compile(rf"\s*f\s+([02])\s+r{(three := 3 * (' ' + _NUMBER))}\s+t{three}\s*")


def read_text(path: AnyPath, targets: bool, headings: Sequence[str]) -> tuple[str, list[list[str]]]:
    """The text of a file, and its poses if it is YAML or JSON; or those in files with one each.

    A pattern stands for files in the order of the numbers in their names. If samples have two
    poses, those of the target are read if `targets`, else the flange's. The headings are those of
    the rotation.
    """
    files, text, rows = [path_of(path)], "", []
    if files[0].is_dir():
        raise InvalidFile(path, "it is a folder; try: a pattern in quotes, such as 'poses/*.yaml'")
    if each := not files[0].exists() and "*" in str(path):
        files = [*map(Path, sorted(glob(str(path)), key=_in_order))]
    for file in files:
        if b"\0" in (content := read_file(file, MOST)):
            valid = "text, as by numpy.savetxt(FILE, poses.reshape(-1, 16))"
            raise InvalidFile(file, f"it is binary; expected: {valid}")
        text = _COMMENT.sub("", _HEADER.sub("", content.decode("utf-8-sig", "replace")))
        poses: list[list[str]] = []
        if len(text) < MOST_TREE and "&" not in text:  # anchors can be repeated without an end
            tree = re.sub(r"\}\s*\n\s*\{", "}\n---\n{", OF_OPENCV.sub("", text).replace("\t", " "))
            with suppress(ValueError, TypeError, KeyError, RecursionError, yaml.YAMLError):
                poses = [*poses_in([*yaml.safe_load_all(tree)], targets, headings)]
        numbers = BETWEEN.split(BRACKETS.sub(" ", text).strip())
        rows += poses or _labelled(text, headings) or [numbers] * each
        if not rows and file.suffix.lower() in (".json", ".yaml", ".yml", ".xml"):
            valid = "lists of 12 or 16 numbers, or 'translation' and 'rotation'; try: --convention"
            raise InvalidFile(file, f"it has no poses; expected: {valid}")
    return text, rows


def _in_order(name: str) -> list[str | int]:
    parts = re.split(r"(\d+)", name)
    return [int(part) if at % 2 else part for at, part in enumerate(parts)]


def _labelled(text: str, headings: Sequence[str]) -> list[list[str]]:
    """Poses whose numbers follow their names, as in `X 1.5, Y -2`, or HALCON's; none without."""
    if found := _HALCON.fullmatch(text):
        numbers = np.array(found.groups()[1:], float)
        turn = Rotation.from_euler("xyz" if found[1] == "2" else "XYZ", numbers[:3], degrees=True)
        return _joined(numbers[None, 3:], turn.as_matrix().reshape(1, 9))
    before = (rf"(?i)(?<![\w.]){name}[\s:=]+{_NUMBER}" for name in (*"xyz", *headings))
    columns = [re.findall(each, text) for each in before]
    same = headings and len({*map(len, columns)}) == 1
    return [[*row] for row in zip(*columns, strict=True)] if same else []


def poses_in(tree: Any, targets: bool, headings: Sequence[str]) -> Iterator[list[str]]:
    """The cells of each pose in lists and dictionaries: numbers, and the name of its picture."""
    if isinstance(tree, list):
        cells = [*map(str, _flat(tree))]
        words = [cell for cell in cells if not np.isfinite(number_in(cell))]
        if len(cells) - len(words) in COUNTS and words == [*filter(NAMED.search, words)][:1]:
            yield cells
        else:
            yield from chain(*(poses_in(part, targets, headings) for part in tree))
    if not isinstance(tree, dict):
        return
    parts, found = _parts(tree, headings), {}
    sizes = {name: len(_flat(part)) for name, part in parts.items()}
    turns = [name for name in parts if _TURN.search(name)]
    for place in [name for name in parts if _PLACE.search(name) and sizes[name]]:
        count, ends = divmod(sizes[place], 3)
        fits = [
            (_PLACE.sub("", place) != _TURN.sub("", turn), -sizes[turn], turn)
            for turn in turns
            if not ends and sizes[turn] in (3 * count, 4 * count, 9 * count)
        ]
        if fits:
            turns.remove(turn := min(fits)[2])
            numbers = (np.array(_flat(parts.pop(name)), float) for name in (place, turn))
            places, rotations = (each.reshape(count, -1) for each in numbers)
            found[place] = _joined(places, rotations, turn)
    for name, part in parts.items():
        if name not in turns or sizes[name] not in (6, 7):  # else they are joints
            rows = [*poses_in(part, targets, headings)]
            found[name] = [[name, *row] if NAMED.search(name) else row for row in rows]
    pictures = [part for part in tree.values() if isinstance(part, str) and NAMED.search(part)]
    ours = [rows for name, rows in found.items() if bool(_OF_TARGETS.search(name)) == targets]
    for row in chain(*(ours if any(ours) else found.values())):
        yield [*pictures[:1], *row]


def _joined(places: np.ndarray, turns: np.ndarray, name: str = "") -> list[list[str]]:
    """Rows of a position (n, 3) and a matrix, or of both as they are if the name leaves it open."""
    if found := re.search("wxyz|xyzw", name):
        turns = Rotation.from_quat(turns, scalar_first=found[0] == "wxyz").as_matrix()
    elif _VECTOR.search(name) and turns.shape[1] == 3:
        turns = Rotation.from_rotvec(turns).as_matrix()
    turns = turns.reshape(len(places), -1)
    whole = turns.shape[1] == 9
    rows = np.insert(turns, (3, 6, 9), places, axis=1) if whole else np.hstack([places, turns])
    return [[*map(repr, row)] for row in rows.tolist()]


def _parts(tree: dict[Any, Any], headings: Sequence[str]) -> dict[str, Any]:
    """What a dictionary has, by names in small letters; the numbers of axes are lists."""
    cells = {_STUCK.sub("_", str(name)).lower(): part for name, part in tree.items()}
    parts: dict[str, Any] = {}
    names = [_STUCK.sub("_", name) for name in headings]
    if names and cells.keys() >= {*names}:
        parts["rotation"] = [cells.pop(name) for name in names]
    for name, part in cells.items():
        axis = None if isinstance(part, list | dict) else _AXIS.fullmatch(name)
        if axis:  # x, y and z are a position if their name is not of a rotation
            of = axis[1] or ""
            of += "" if axis[2].isdigit() or _TURN.search(of) else "_t"
            parts.setdefault(of, {})[axis[2]] = part
        elif isinstance(part, str):
            parts[name] = BETWEEN.split(BRACKETS.sub(" ", part).strip())
        else:
            parts[name] = part
    for name in [*parts]:
        axes = {*parts[name]} if isinstance(parts[name], dict) else {"none"}
        if "data" in axes:
            parts[name] = parts[name]["data"]
        elif axes == {*names} or all(map(_AXIS.fullmatch, axes)):
            part = parts.pop(name)
            order = names if axes == {*names} else sorted(axes, key=lambda axis: (len(axis), axis))
            parts[f"{name}_wxyz" if order[0] == "w" else name] = [part[axis] for axis in order]
    return {name: part for name, part in parts.items() if not _OTHER.search(name)}


def _flat(tree: Any) -> list[Any]:
    if isinstance(tree, dict) and "data" in tree:
        return _flat(tree["data"])
    return [*chain(*map(_flat, tree))] if isinstance(tree, list) else [tree]
