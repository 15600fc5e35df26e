"""What pictures of ideas are made of: boxes with words, arrows between them, arms."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb

from recalib.study.plots.palette import STYLES

INK = "0.25"
LEARNED = STYLES["improved"].color  # what the improved map makes


def blank(axes: Axes, width: float, height: float) -> None:
    """A sheet without axes, from (0, 0) to (width, height), not distorted."""
    axes.set(xlim=(0, width), ylim=(0, height), aspect="equal")
    axes.axis("off")


def box(axes: Axes, x: float, y: float, text: str, color: str = INK) -> None:
    """Words in a box around (x, y), with an edge of this colour."""
    fill = tuple(1 - 0.1 * (1 - part) for part in to_rgb(color))
    axes.text(
        x,
        y,
        text,
        ha="center",
        va="center",
        linespacing=1.3,
        bbox={"boxstyle": "round,pad=0.45", "facecolor": fill, "edgecolor": color},
    )


def arrow(axes: Axes, start, end, color: str = INK, bend: float = 0.0, width: float = 1.5) -> None:
    """An arrow from start to end, both (x, y); bent to one side by a part of its length."""
    axes.annotate(
        "",
        end,
        start,
        arrowprops={
            "arrowstyle": "-|>",
            "color": color,
            "linewidth": width,
            "shrinkA": 0,
            "shrinkB": 0,
            "mutation_scale": 14,
            "connectionstyle": f"arc3,rad={bend}",
        },
    )


def planar_arm(angles, lengths) -> np.ndarray:
    """Joints and tip (joint + 1, 2) of an arm in a plane, from its joint angles [rad]."""
    directions = np.cumsum(angles)
    steps = np.asarray(lengths)[:, None] * np.stack([np.cos(directions), np.sin(directions)], 1)
    return np.concatenate([[[0.0, 0.0]], np.cumsum(steps, axis=0)])
