"""Is the new mapping more similar to the old one than to a constant (section 5)? The integrals E_clas and E_upd."""

from collections.abc import Callable

import numpy as np
import pandas as pd

Mapping = Callable[[np.ndarray], np.ndarray]


def ball(generator: np.random.Generator, points: int, dimensions: int, radius: float) -> np.ndarray:
    """Points (points, dimensions) drawn uniformly from a ball about zero."""
    directions = generator.normal(size=(points, dimensions))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return radius * directions * generator.uniform(size=(points, 1)) ** (1 / dimensions)


def propagation_errors(
    old: Mapping, new: Mapping, centre: np.ndarray, offsets: np.ndarray
) -> tuple[float, float]:
    """E_clas and E_upd of section 5, as means over the ball instead of integrals.

    Args:
        old, new: f and f', from points (n, 6) to values (n, ...): commands, or Jacobians for the second half of the section.
        centre: (6,) of the ball, where the winner is.
        offsets: (n, 6) points of the ball relative to its centre.
    """
    points = centre + offsets
    f, f_new = old(points), new(points)
    f_centre, f_new_centre = old(centre[None]), new(centre[None])
    axes = tuple(range(1, f.ndim))
    classic = np.square(f_new_centre - f_new).sum(axis=axes)
    updated = np.square(f + (f_new_centre - f_centre) - f_new).sum(axis=axes)
    return float(classic.mean()), float(updated.mean())


def integral_ratios(table: pd.DataFrame) -> pd.Series:
    """E_upd / E_clas for each kind, start and scale: the median over the balls of `propagation_errors`.

    Scales at which a pose of some ball has no command are left out: the balls that remain would be the easy ones.
    """
    balls = table.assign(ratio=table["updated"] / table["classic"]).groupby(
        ["kind", "start", "scale"]
    )["ratio"]
    return balls.median()[balls.count() == balls.size()]
