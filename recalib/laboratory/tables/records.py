"""Poses in lists and dictionaries, as other programs write them in YAML, JSON or a table."""

import re
from collections.abc import Iterator, Sequence
from itertools import chain
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.laboratory.tables.columns import ROLL_PITCH_YAW
from recalib.laboratory.tables.table import number_in

COUNTS = 6, 7, 12, 16  # numbers of a pose
NAMED = re.compile(r"\.(png|jpe?g|bmp|tiff?|pgm)$", re.IGNORECASE)  # a picture
BETWEEN, BRACKETS = re.compile(r"[\s,;\"']+"), re.compile(r"\bp(?=\[)|[\[\](){}]")
# in names: of the target; of something else; of positions; of rotations
_OF_TARGETS = re.compile(
    "object|target|track|optical|marker|board|cam|eye|[rt]vec|pattern|tag|detect|vision|chess|aruco"
)
_OTHER = re.compile("joint|axis|force|torque|wrench|speed|vel|dist|coef|intrinsic|camera_mat")
_PLACE = re.compile(
    "(?<![a-z])(t|p|pos|xyz|tvec|trans|translation|position|location)s?(?![a-z])(_vector)?"
)
_TURN = re.compile(
    "(?<![a-z])(r|q|rot|quat|quaternion|rvec|rotvec|rotation|orientation|euler|rpy)s?(?![a-z])"
    "(_(wxyz|xyzw|vector|vec|matrix))?"
)
_VECTOR = re.compile("rvec|rotvec|rotation_vec")  # [rad]
_CAPITAL, _STUCK = r"(?<=[a-z])(?=[A-Z])", r"(?<=(?<![a-z])[tprq])(?=([xyzw]|\d\d?)$)"
_UNSEEN = re.compile(r"\W*|\D*\b(nan|none)\b\D*", re.IGNORECASE)  # a target
_REAL = re.compile(r"\d\.\d")
_AXIS = re.compile(r"(?:(.*)[_./ \[])?([xyzw]|\d\d?)\]?")


def poses_in(tree: Any, targets: bool, headings: Sequence[str]) -> Iterator[list[str]]:
    """The cells of each pose in a tree: numbers, and the name of its picture.

    If samples have two poses, those of the target are read if `targets`, else the flange's. A
    sample without the target's is left out. `headings` name the numbers of rotations. A pose is a
    position and a matrix, row by row, or else both as they are written.
    """
    if isinstance(tree, list):
        cells = [*map(str, _flat(tree))]
        words = [cell for cell in cells if not np.isfinite(number_in(cell))]
        if len(cells) - len(words) in COUNTS and words == [*filter(NAMED.search, words)][:1]:
            yield cells
        else:
            whole = [*filter(_has_target, tree)] or tree
            yield from chain(*(poses_in(part, targets, headings) for part in whole))
    if not isinstance(tree, dict):
        return
    parts = _parts(tree, headings)
    sizes = {name: len(_flat(part)) for name, part in parts.items()}
    if any(
        _OF_TARGETS.search(name) and _UNSEEN.fullmatch(str(part)) for name, part in parts.items()
    ):
        return
    found: dict[str, list[list[str]]] = {}
    for place, turn in _pairs(sizes):
        both = [[*map(str, _flat(parts.pop(name)))] for name in (place, turn)]
        places, turns = (
            np.reshape([*map(number_in, each)], (sizes[place] // 3, -1)) for each in both
        )
        good = np.isfinite(places).all() and np.isfinite(turns).all()
        found[place] = _joined(places, turns, turn) if good else [[*chain(*both)]]
    for name, part in parts.items():
        if not _TURN.search(name) or sizes[name] not in (6, 7):  # else they are joints
            found[name] = [*poses_in(part, targets, headings)]
    if len({re.sub(r"\d+", "", name) for name in found}) == 1:
        found = {name: found[name] for name in sorted(found, key=in_order)}
    pictures = [part for part in tree.values() if isinstance(part, str) and NAMED.search(part)]
    files = {str(name).lower(): [str(name)] for name in tree if NAMED.search(str(name))}
    named = {
        name: [[*files.get(name, pictures[:1]), *row] for row in rows]
        for name, rows in found.items()
    }
    ours = [name for name in named if bool(_OF_TARGETS.search(name)) == targets]
    unread = any(len(_REAL.findall(str(parts.get(name)))) >= COUNTS[0] for name in ours)
    some = unread or any(named[name] for name in ours)
    yield from chain(*(named[name] for name in (ours if some else named)))


def _has_target(part: Any) -> bool:
    named = part.items() if isinstance(part, dict) else ()
    return any(
        _OF_TARGETS.search(str(name).lower()) and _REAL.search(str(it)) for name, it in named
    )


def in_order(name: str) -> list[str | int]:
    """A key that sorts names with numbers by value."""
    parts = re.split(r"(\d+)", name)
    return [int(part) if at % 2 else part for at, part in enumerate(parts)]


def _pairs(sizes: dict[str, int]) -> Iterator[tuple[str, str]]:
    """Names of positions, and each with that of its rotations, by their counts of numbers."""
    fits = [
        (place, turn)
        for place in sizes
        for turn in sorted(filter(_TURN.search, sizes), key=lambda name: -sizes[name])
        if place != turn
        and _PLACE.search(place)
        and sizes[place] % 3 == 0
        and sizes[turn] * 3 in (3 * sizes[place], 4 * sizes[place], 9 * sizes[place])
    ]
    same = [(place, turn) for place, turn in fits if _PLACE.sub("", place) == _TURN.sub("", turn)]
    first = {place: (place, turn) for place, turn in reversed(same)}
    yield from first.values() if same else fits if len(fits) == 1 else ()


def _joined(places: np.ndarray, turns: np.ndarray, name: str) -> list[list[str]]:
    """Rows of positions (n, 3) and matrices, or rotations as they are if the name does not tell."""
    if (found := re.search("wxyz|xyzw", name)) and turns.shape[1] == 4:
        scale = np.linalg.norm(turns, axis=1)[:, None, None]  # which is checked later
        turns = scale * Rotation.from_quat(turns, scalar_first=found[0] == "wxyz").as_matrix()
    elif _VECTOR.search(name) and turns.shape[1] == 3:
        turns = Rotation.from_rotvec(turns).as_matrix()
    turns = turns.reshape(len(places), -1)
    whole = turns.shape[1] == 9
    rows = np.insert(turns, (3, 6, 9), places, axis=1) if whole else np.hstack([places, turns])
    return [[*map(repr, row)] for row in rows.tolist()]


def _parts(tree: dict[Any, Any], headings: Sequence[str]) -> dict[str, Any]:
    """What a dictionary has, by names in small letters; the numbers of axes are lists."""
    cells = {re.sub(_CAPITAL, "_", str(name)).lower(): part for name, part in tree.items()}
    parts: dict[str, Any] = {}
    orders = [each for each in (headings, ROLL_PITCH_YAW.headings) if each]
    if names := next((each for each in orders if cells.keys() >= {*each}), ()):
        parts["rotation"] = [cells.pop(name) for name in names]
    for name, part in cells.items():
        axis = _AXIS.fullmatch(re.sub(_STUCK, "_", name))
        if axis and not isinstance(part, list | dict):
            of = axis[1] or ""  # x, y and z are a position if their name is not of a rotation
            of += "" if axis[2].isdigit() or _TURN.search(of) or _PLACE.search(of) else "_t"
            parts.setdefault(of, {})[axis[2]] = part
        else:
            words = BETWEEN.split(BRACKETS.sub(" ", str(part)).strip())
            parts[name] = words if isinstance(part, str) else part
    for name in [*parts]:
        if not isinstance(parts[name], dict):
            continue
        axes = {str(axis).lower(): cell for axis, cell in parts[name].items()}
        order: Sequence[str] = next((each for each in orders if axes.keys() == {*each}), ())
        if all(map(_AXIS.fullmatch, axes)):
            order = sorted(axes, key=lambda axis: (len(axis), axis))  # w first
        if order and not any(isinstance(cell, list | dict) for cell in axes.values()):
            del parts[name]
            parts[f"{name}_wxyz" if order[0] == "w" and "x" in order else name] = [
                axes[axis] for axis in order
            ]
    return {name: part for name, part in parts.items() if not _OTHER.search(name)}


def _flat(tree: Any) -> list[Any]:
    if isinstance(tree, dict) and "data" in tree:  # a matrix of OpenCV
        return _flat(tree["data"])
    return [*chain(*map(_flat, tree))] if isinstance(tree, list) else [tree]
