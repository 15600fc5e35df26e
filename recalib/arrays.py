"""Checks of arrays from callers: their shapes, finite numbers, and valid rotations."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from recalib.errors import InvalidSetting
from recalib.files.quantities import Quantity

SKEW = 1e-3  # tolerance on the orthonormality of a rotation: more than rounding
Shape = Sequence[int | str]  # sizes, or letters that stand for any size


def array_of(name: str, given: ArrayLike, *shapes: Shape) -> np.ndarray:
    """The given values as an array of finite floats that has one of the shapes, such as ("n", 3).

    Raises InvalidSetting, with the value found and the values expected.
    """
    array = _numbers_in(given)
    if np.ma.is_masked(given):
        found = "a masked array"
    elif array is None:
        found = type(given).__name__
    elif not any(_fits(array, shape) for shape in shapes):
        found = f"of shape {array.shape}"
    elif not np.isfinite(array).all():
        found = "an array with NaN or infinity"
    else:
        return array.copy()
    texts = (f"({', '.join(map(str, shape))}{',' * (len(shape) == 1)})" for shape in shapes)
    raise InvalidSetting(name, found, f"an array of finite numbers of shape {' or '.join(texts)}")


def numbers(name: str, given: ArrayLike) -> np.ndarray:
    """The given numbers as an array of any shape. Raises InvalidSetting if they are not numbers."""
    if (array := _numbers_in(given)) is None:
        raise InvalidSetting(name, type(given).__name__, "an array of numbers")
    return array


def _numbers_in(given: ArrayLike) -> np.ndarray | None:
    try:
        array = np.asarray(given)
    except ValueError:  # rows of different lengths
        return None
    return array.astype(float, copy=False) if array.dtype.kind in "iuf" else None


def ending(name: str, given: ArrayLike, *last: int) -> np.ndarray:
    """The given numbers as an array whose last axes have these sizes. Raises InvalidSetting."""
    array = numbers(name, given)
    if array.shape[-len(last) :] != last:
        axes = ", ".join(map(str, ("...", *last)))
        raise InvalidSetting(name, f"of shape {array.shape}", f"an array of shape ({axes})")
    return array


def are_poses(matrices: np.ndarray, skew: float, last_row: float = 0.0) -> np.ndarray:
    """Whether each of the matrices (..., 4, 4) is a pose: not transposed, mirrored or scaled.

    Arguments are the tolerances of R R' = 1, and of the last row.
    """
    turns = matrices[..., :3, :3]
    off = np.abs(turns @ turns.swapaxes(-2, -1) - np.eye(3)).max(axis=(-2, -1))
    ends = np.abs(matrices[..., 3, :] - [0, 0, 0, 1]).max(axis=-1)
    return (ends <= last_row) & (off < skew) & (np.linalg.det(turns) > 0)


def check_rotations(name: str, poses: np.ndarray) -> None:
    """Raise InvalidSetting unless all matrices (..., 4, 4) are poses."""
    if not are_poses(poses, SKEW, SKEW).all():
        valid = "poses: a rotation (3, 3), a position (3,) in m, and the last row 0, 0, 0, 1"
        raise InvalidSetting(name, "matrices that are not poses", valid)


def check_size(name: str, numbers: np.ndarray, quantity: Quantity) -> None:
    """Raise InvalidSetting if numbers in SI units exceed the largest plausible value for an arm."""
    if (largest := np.abs(numbers).max(initial=0)) > quantity.farthest:
        unit = next(unit for unit, size in quantity.units.items() if size == 1)
        valid = f"up to {quantity.write(quantity.farthest)}; is its unit right?"
        raise InvalidSetting(name, f"up to {largest:.3g} {unit}", valid)


def _fits(array: np.ndarray, shape: Shape) -> bool:
    sizes = zip(array.shape, shape, strict=False)
    right = (isinstance(wanted, str) or size == wanted for size, wanted in sizes)
    return array.ndim == len(shape) and all(right)
