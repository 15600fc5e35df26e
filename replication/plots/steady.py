"""Make figures reproducible: the same data give the same bytes on every machine.

Machines differ in the last digits of a sum or a logarithm. So all drawn values are rounded to the
visible digits, and so are the logarithms of axes; afterwards there are only sums and products,
which are the same everywhere. A value may still lie on the border between two roundings. So the
borders are moved away from round numbers, halves and quarters, and only chance puts a value there:
relative noise of 1e-9 changes about one in 100,000 values.
"""

from collections.abc import Callable
from functools import partial

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.collections import Collection
from matplotlib.figure import Figure
from matplotlib.scale import LogScale, LogTransform, register_scale
from matplotlib.text import Annotation
from matplotlib.transforms import Transform
from numpy.typing import ArrayLike

LOG = "rounded log"  # name of the scale of logarithmic axes
DIGITS = 4  # visible digits
BORDER = 0.4567  # added before rounding down: an unusual number instead of one half


class _RoundedLogTransform(LogTransform):
    """Logarithms to nine decimals: their last digits depend on the processor."""

    def transform_non_affine(self, values: ArrayLike) -> np.ndarray:
        return np.round(np.asarray(super().transform_non_affine(values)), 9)


class RoundedLogScale(LogScale):
    """A logarithmic scale whose logarithms are the same on every machine."""

    name = LOG

    def __init__(self) -> None:
        super().__init__()

    def get_transform(self) -> LogTransform:
        return _RoundedLogTransform(10)


register_scale(RoundedLogScale)


def _power_of_ten(value: float) -> int:
    """The decimal exponent of a number. It is exact; a rounded logarithm may not be."""
    return int(f"{value:e}".split("e")[1]) if np.isfinite(value) else 0


def rounded(values: ArrayLike, scale: float | None = None) -> np.ndarray:
    """Values rounded to `DIGITS` digits each or, with `scale`, all to `DIGITS` digits below it."""
    values = np.array(values, dtype=float)
    if scale is None:
        powers = [_power_of_ten(value) + 1 for value in values.ravel()]
    else:
        powers = [_power_of_ten(scale)] * values.size
    steps = np.reshape([float(f"1e{power - DIGITS}") for power in powers], values.shape)
    return np.floor(values / steps + BORDER) * steps


def _round_on(axis: Axis, values: ArrayLike) -> np.ndarray:
    if axis.get_scale() == LOG:
        return rounded(values)
    low, high = axis.get_view_interval()
    return rounded(values, abs(high - low))


def steady(figure: Figure) -> None:
    """Round everything that is drawn in the axes of a figure, and the axes' limits."""
    for axes in figure.axes:
        both = partial(_round_points, axes)

        limits = axes.get_xlim(), axes.get_ylim()
        for line in axes.lines:
            line.set_data(both(np.array(line.get_data(orig=False)).T).T)
        for collection in axes.collections:
            _round_collection(collection, axes.transData, both)
        for text in axes.texts:
            if isinstance(text, Annotation):
                text.xy = tuple(both(np.array([text.xy], dtype=float))[0])
        axes.set_xlim(*_round_on(axes.xaxis, limits[0]))
        axes.set_ylim(*_round_on(axes.yaxis, limits[1]))


def _round_points(axes: Axes, points: np.ndarray) -> np.ndarray:
    scales = axes.xaxis, axes.yaxis
    return np.stack([_round_on(axis, points[:, i]) for i, axis in enumerate(scales)], 1)


def _round_collection(
    collection: Collection, data: Transform, both: Callable[[np.ndarray], np.ndarray]
) -> None:
    if collection.get_offset_transform() is data:
        collection.set_offsets(both(np.asarray(collection.get_offsets())))
        return
    for path in collection.get_paths():
        path.vertices = both(np.asarray(path.vertices))
