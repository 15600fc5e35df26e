"""Poses in lists and dictionaries, as other programs write them in YAML, JSON or a table.

Names are read by their words, as in `R_gripper2base`, `pose.orientation.w` or `tvec`: one tells a
position from a rotation, the last may be an axis, and the others tell whose pose it is.
"""

import re
from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from itertools import chain
from typing import Any, NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.laboratory.tables.columns import ROLL_PITCH_YAW
from recalib.laboratory.tables.table import number_in

COUNTS = 6, 7, 12, 16  # numbers of a pose
NAMED = re.compile(r"\.(png|jpe?g|bmp|tiff?|pgm)$", re.IGNORECASE)  # a picture
_BETWEEN, _BRACKETS = re.compile(r"[\s,;\"']+"), re.compile(r"\bp(?=\[)|[\[\](){}]")
WORD = re.compile(r"\d+|[A-Za-z](?=[w-zW-Z](?![A-Za-z]))|[A-Z]+(?![a-z])|[A-Z]?[a-z]+")
PLACES = {"t", "p", "pos", "xyz", "tvec", "trans", "translation", "position", "location"}
TURNS = {"r", "q", "rvec", "rotvec", "rot", "quat", "quaternion", "rotation", "orientation"}
TURNS |= {"euler", "rpy"}
VECTORS, ORDERS = {"rvec", "rotvec", "vec", "vector"}, {"wxyz", "xyzw"}  # [rad]; of quaternions
FORMS = VECTORS | ORDERS | {"matrix"}
OF_TARGETS = re.compile(
    "object|target|track|optical|marker|board|cam|eye|pattern|tag|detect|vision|chess|aruco"
)
OF_NEITHER = re.compile("joint|axis|force|torque|wrench|speed|vel|dist|coef|intrinsic|camera mat")

Rows = list[list[str]]  # the cells of poses: numbers, and the name of a picture


class Name(NamedTuple):
    """What the words of a name tell."""

    owner: str  # whose pose it is
    kinds: frozenset[str]  # that it is a position or a rotation, and how this is written

    @property
    def of_target(self) -> bool:
        return bool(OF_TARGETS.search(self.owner))


def poses_in(tree: Any, targets: bool, headings: Sequence[str]) -> Rows:
    """The cells of each pose in a tree: numbers, and the name of its picture.

    If samples have two poses, those of the target are read if `targets`, else the flange's, and
    samples with one pose are left out. Poses named as a target's are never read as the flange's.
    `headings` name the numbers of rotations. The numbers are a matrix row by row, or a position and
    a rotation as it is written.
    """
    ours, theirs = _both(tree, headings)
    return theirs or ours if targets else ours


def cells_of(text: str) -> list[str]:
    """The words and numbers of a text, without brackets and separators."""
    return [cell for cell in _BETWEEN.split(_BRACKETS.sub(" ", text)) if cell]


def in_order(name: str) -> list[str | int]:
    """A key that sorts names with numbers by value."""
    parts = re.split(r"(\d+)", name)
    return [int(part) if at % 2 else part for at, part in enumerate(parts)]


def _both(tree: Any, headings: Sequence[str]) -> tuple[Rows, Rows]:
    """The poses of the flange, or without a name, and those of the target."""
    if isinstance(tree, list):
        cells = [*map(str, _flat(tree))]
        words = [cell for cell in cells if not np.isfinite(number_in(cell))]
        if len(cells) - len(words) in COUNTS and words == [*filter(NAMED.search, words)][:1]:
            return [cells], []
        samples = [_both(part, headings) for part in tree]
        whole = [sample for sample in samples if all(sample)] or samples
        return [*chain(*(ours for ours, _ in whole))], [*chain(*(theirs for _, theirs in whole))]
    if not isinstance(tree, dict):
        return [], []
    parts = {name: tree[name] for name in sorted(tree, key=lambda name: in_order(str(name)))}
    names = [*map(str, parts)]
    if any(map(NAMED.search, names)):
        named = zip(names, parts.values(), strict=True)
        return _both([{"picture": name, "pose": part} for name, part in named], headings)
    nested = [part for part in parts.values() if isinstance(part, list | dict)]
    if len(nested) > 1 == len({re.sub(r"\d+", "", name) for name in names}):  # numbered samples
        return _both(nested, headings)
    return _of_sample(tree, headings)


def _of_sample(tree: dict[Any, Any], headings: Sequence[str]) -> tuple[Rows, Rows]:
    """The poses in a dictionary whose names tell whose they are."""
    found: tuple[Rows, Rows] = [], []
    leaves = [*_leaves(tree)]
    numbers = _numbers(leaves, headings)
    pairs = [*_pairs(numbers)]
    for name, whole in numbers.items():
        if not name.kinds & TURNS and not any(name.owner == place.owner for place, _ in pairs):
            ours, theirs = _both(whole, headings)
            found[1].extend(theirs)
            found[name.of_target].extend(ours)
    for place, turn in sorted(pairs, key=lambda pair: not pair[0].owner):
        rows = _joined(numbers[place], numbers[turn], turn.kinds)
        beside = not place.owner and "tvec" in place.kinds and bool(found[0])  # as by OpenCV
        of_target = place.of_target or turn.of_target or beside
        if not of_target or np.isfinite(rows).all():  # else it was not found
            found[of_target].extend([*map(repr, row)] for row in rows.tolist())
    pictures = [part for _, part in leaves if isinstance(part, str) and NAMED.search(part)][-1:]
    return [pictures + row for row in found[0]], [pictures + row for row in found[1]]


def _numbers(
    leaves: Iterable[tuple[list[str], Any]], headings: Sequence[str]
) -> dict[Name, list[Any]]:
    """The numbers of positions, rotations and poses, in lists or in the order of their axes."""
    axes = [*headings, *ROLL_PITCH_YAW.headings, *"wxyz"]
    lists, cells = dict[Name, list[Any]](), defaultdict[Name, dict[str, Any]](dict)
    for words, part in leaves:
        if OF_NEITHER.search(" ".join(words)):
            continue
        if isinstance(part, str):
            part = cells_of(part)
        whole = _flat(part)
        if len(whole) == 1 and words and (words[-1] in axes or words[-1].isdigit()):
            cells[_name(words[:-1], words[-1])][words[-1]] = whole[0]
        else:
            lists[_name(words)] = part if isinstance(part, list) else whole
    for name, by_axis in cells.items():
        order = sorted(by_axis, key=lambda axis: int(axis) if axis.isdigit() else axes.index(axis))
        kinds = name.kinds | {"wxyz"} if {"w", "x"} <= {*order} else name.kinds
        lists[name._replace(kinds=kinds)] = [by_axis[axis] for axis in order]
    return lists


def _leaves(tree: dict[Any, Any], before: Sequence[str] = ()) -> Iterator[tuple[list[str], Any]]:
    """What nested dictionaries hold, by the words of the names that lead there."""
    for name, part in tree.items():
        words = [*before, *map(str.lower, WORD.findall(str(name)))]
        if isinstance(part, dict) and "data" not in part:  # else a matrix of OpenCV
            yield from _leaves(part, words)
        else:
            yield words, part


def _name(words: Sequence[str], axis: str = "") -> Name:
    """What words tell, together with an axis: the first that is known tells the kind."""
    words = [word if word in PLACES else word.removesuffix("s") for word in words]
    kinds = [word for word in words if word in PLACES | TURNS][:1]
    if not kinds and axis and not axis.isdigit():
        kinds = ["position" if axis in ("x", "y", "z") else "rotation"]
    forms = [word for word in words if word in FORMS]
    others = [word for word in words if word not in (*kinds, *forms)]
    return Name(" ".join(others), frozenset((*kinds, *forms)))


def _pairs(numbers: Mapping[Name, list[Any]]) -> Iterator[tuple[Name, Name]]:
    """Names of positions, and of rotations with them: of several, those of most numbers."""
    counts = {name: len(_flat(whole)) for name, whole in numbers.items()}
    fits = [
        (place, turn)
        for place in numbers
        for turn in sorted(numbers, key=lambda name: -counts[name])
        if place.kinds & PLACES and turn.kinds & TURNS and counts[place] % 3 == 0
        if 3 * counts[turn] in [count * counts[place] for count in (3, 4, 9)]
    ]
    same = [(place, turn) for place, turn in fits if place.owner == turn.owner]
    first = {place.owner: (place, turn) for place, turn in reversed(same)}
    yield from first.values() if same else fits if len(fits) == 1 else ()


def _joined(place: list[Any], turn: list[Any], kinds: Collection[str]) -> np.ndarray:
    """Rows of positions and matrices, or of rotations as they are if their name does not tell."""
    places, turns = (np.array([number_in(str(n)) for n in _flat(each)]) for each in (place, turn))
    places = places.reshape(-1, 3)
    turns = turns.reshape(len(places), -1)
    if not np.isfinite(turns).all():  # which is refused later
        kinds = ()
    if turns.shape[1] == 4 and ORDERS.intersection(kinds):
        scale = np.linalg.norm(turns, axis=1)[:, None, None]  # which is checked later
        turns = scale * Rotation.from_quat(turns, scalar_first="wxyz" in kinds).as_matrix()
    elif turns.shape[1] == 3 and VECTORS.intersection(kinds):
        turns = Rotation.from_rotvec(turns).as_matrix()
    turns = turns.reshape(len(places), -1)
    matrices = turns.shape[1] == 9
    return np.insert(turns, (3, 6, 9), places, axis=1) if matrices else np.hstack([places, turns])


def _flat(tree: Any) -> list[Any]:
    if isinstance(tree, dict) and "data" in tree:  # a matrix of OpenCV
        return _flat(tree["data"])
    return [*chain(*map(_flat, tree))] if isinstance(tree, list) else [tree]
