"""Mistakes that people make in tables, each with the step that undoes it."""

from collections.abc import Callable, Iterator
from functools import partial
from itertools import combinations, combinations_with_replacement
from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.nominal.kinematics import Arm

SHIFTED = "joints of the row"
TURNS = {"degrees labelled rad": np.pi / 180, "radians labelled deg": 180 / np.pi}
PARTS = {"half of its turn": 2.0, "twice its turn": 0.5}
UNITS = {  # wrong units of positions, by the factor that corrects the positions
    1e-3: "in millimetres labelled m",
    1e-2: "in centimetres labelled m",
    1e-1: "in millimetres labelled cm",
    1e1: "in centimetres labelled mm",
    25.4: "in inches labelled mm",
    1e2: "in metres labelled cm",
    1e3: "in metres labelled mm",
}
QUARTERS = 90, -90, -180  # degrees

Change = Callable[[np.ndarray], np.ndarray]


class Step(NamedTuple):
    """A mistake in words, and the changes of joints and of positions or poses that undo it."""

    words: str
    joints: Change = np.asarray
    measured: Change = np.asarray
    of_neighbours: bool = False  # whether it mixes up rows, so that it shows only in all of them


def steps_of(arm: Arm) -> Iterator[Step]:
    """Frequent mistakes in columns of joints and positions, which may come in pairs."""
    count, each = len(arm.joints), np.eye(len(arm.joints))
    for words, factor in TURNS.items():
        scale = np.where(arm.slides, 1.0, factor)
        yield Step(f"joint columns in {words}", partial(np.multiply, scale))
    for factor, words in UNITS.items():
        yield Step(f"positions {words}", measured=partial(_scaled, factor))
    mirror = partial(_scaled, -1.0)
    yield Step("positions with a reversed axis, or two exchanged", measured=mirror)
    for joint, name in enumerate(arm.joints):
        yield Step(f"the sign of {name}", partial(np.multiply, 1 - 2 * each[joint]))
    for joint, name in enumerate(arm.joints):
        for degrees in () if arm.slides[joint] else QUARTERS:
            shift = partial(np.add, np.radians(degrees) * each[joint])
            yield Step(f"the zero of {name}, off by {-degrees} deg", shift)
    for one, other in combinations(range(count), 2):
        order = np.arange(count)
        order[[one, other]] = other, one
        names = f"{arm.joints[one]} and {arm.joints[other]}"
        exchange = partial(np.take, indices=order, axis=1)
        yield Step(f"the columns of {names} exchanged", exchange)
        if other == one + 1 and arm.slides[one] == arm.slides[other]:  # as in a parallelogram arm
            for column, by, sign in ((other, one, 1), (other, one, -1), (one, other, 1)):
                change = np.eye(count)
                change[by, column] = -sign
                words = f"{arm.joints[column]} {'plus' if sign > 0 else 'minus'} {arm.joints[by]}"
                without = partial(np.dot, b=change)
                yield Step(f"a column {arm.joints[column]} that holds {words}", without)
    yield Step("the joint columns in reverse order", np.fliplr)
    for rows, row in ((-1, "before"), (1, "after")):
        shift = partial(np.roll, shift=rows, axis=0)
        yield Step(f"{SHIFTED} {row}", shift, of_neighbours=True)


def rare_steps_of(arm: Arm) -> Iterator[Step]:
    """Mistakes in some columns of many, or in all joints: each is tried by itself."""
    yield Step("the signs of all joints", np.negative)
    count, turning = np.arange(len(arm.joints)), ~arm.slides
    for first, last in combinations_with_replacement(np.flatnonzero(turning), 2):
        alone, one, other = first == last, arm.joints[first], arm.joints[last]
        some = turning & (first <= count) & (count <= last)
        if not alone and (some == turning).all():  # all of them are a frequent mistake
            continue
        holding = f"a column {one} that holds" if alone else f"columns {one} to {other} that hold"
        for words, factor in (TURNS | (PARTS if alone else {})).items():
            yield Step(f"{holding} {words}", partial(np.multiply, np.where(some, factor, 1.0)))
    for axis, name in enumerate("xyz"):
        for factor in (1e-3, 1e3):
            scale = partial(_scaled, 1 + (factor - 1) * np.eye(3)[axis])
            yield Step(f"a column {name} {UNITS[factor]}", measured=scale)


def steps_of_rotations() -> Iterator[Step]:
    """Mistakes in measured rotations, in any of their notations."""
    inverse = "poses of the instrument in the target's frame; expected: of the target in the"
    yield Step(f"{inverse} instrument's", measured=np.linalg.inv)
    euler = Rotation.from_euler
    changes: dict[str, Callable[[Rotation], Rotation]] = {
        "rotations of the instrument in the target's frame": Rotation.inv,
        "a quaternion in the order qw, qx, qy, qz": (
            lambda turns: Rotation.from_quat(np.roll(turns.as_quat(), -1, axis=1))
        ),
        "roll, pitch and yaw about moving axes": lambda turns: euler("XYZ", _angles(turns)),
        "roll, pitch and yaw in radians labelled deg": (
            lambda turns: euler("xyz", np.degrees(_angles(turns)))
        ),
        "a rotation vector in radians labelled deg": (
            lambda turns: Rotation.from_rotvec(np.degrees(turns.as_rotvec()))
        ),
        "roll, pitch and yaw in reverse order": lambda turns: euler("xyz", _angles(turns)[:, ::-1]),
        **{
            f"rotations of a left-handed frame, or of one half turned about {name}": (
                partial(_mirrored, axis)
            )
            for axis, name in enumerate("xyz")
        },
    }
    for words, change in changes.items():
        yield Step(words, measured=partial(_turned, change))


def _angles(rotations: Rotation) -> np.ndarray:
    """Roll, pitch and yaw (n, 3) [rad]; at a pitch of 90 deg, one of many solutions."""
    return rotations.as_euler("xyz", suppress_warnings=True)


def _scaled(factor: float | np.ndarray, measured: np.ndarray) -> np.ndarray:
    """Positions (n, 3) or poses (n, 4, 4), with positions multiplied by a factor, or (3,)."""
    scaled = measured.copy()
    places = scaled if measured.ndim == 2 else scaled[:, :3, 3]
    places *= factor
    return scaled


def _mirrored(axis: int, rotations: Rotation) -> Rotation:
    """Rotations (n,) as a frame has them whose axis points the other way, or both others do."""
    mirror = np.diag(1.0 - 2 * (np.arange(3) == axis))
    return Rotation.from_matrix(mirror @ rotations.as_matrix() @ mirror)


def _turned(change: Callable[[Rotation], Rotation], poses: np.ndarray) -> np.ndarray:
    """Poses (n, 4, 4) with changed rotations."""
    turned = poses.copy()
    turned[:, :3, :3] = change(Rotation.from_matrix(poses[:, :3, :3])).as_matrix()
    return turned
