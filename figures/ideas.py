"""Draws the pictures of docs/ideas.md with the code that they explain: python figures/ideas.py

They show no result, so no run draws them.
"""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap, to_rgb
from matplotlib.figure import Figure
from scipy.optimize import root

from recalib.learners.nets import Nets, regular_grid
from recalib.learners.rules import IMPROVED
from recalib.learners.schedules import DIMENSIONS, EXPONENTIAL, expected_learning, fall
from replication.plots.palette import BOTH, FAILS, INK, NEUTRAL, STYLES, styles_of
from replication.plots.style import STYLE, WIDTH, legend_below, save

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


NOMINAL, DAMAGED = (1.0, 0.9), (1.0, 0.72)  # lengths of links, shortened as bad ones are
SLIPPED = np.radians([0, 14])  # encoders
BASE = np.array([0.25, 0.12])
DESIRED = np.array([1.45, 0.55])  # from the base


def believed(pose: np.ndarray) -> np.ndarray:
    """Angles (2,) that the controller sends for a pose (2,): it knows of no damage."""
    found = root(lambda angles: planar_arm(angles, NOMINAL)[-1] - pose, [1.0, -1.2])
    return np.round(found.x, 9)


def really(pose: np.ndarray) -> np.ndarray:
    """Joints and tip (3, 2) of the damaged arm, when it is sent to a pose."""
    return planar_arm(believed(pose) + SLIPPED, DAMAGED)


def fake_pose() -> Figure:
    """Where an arm goes that is sent to the desired pose, and to the fake one."""
    figure, panels = plt.subplots(1, 3, figsize=(WIDTH, 1.3))
    fake = np.round(root(lambda pose: really(pose)[-1] - DESIRED, DESIRED).x, 9)
    for axes in panels:
        blank(axes, 2.35, 1.15)
        axes.axhline(BASE[1] - 0.06, color=INK, linewidth=0.8)
    _arm(panels[0], planar_arm(believed(DESIRED), NOMINAL), INK)
    _arm(panels[1], planar_arm(believed(DESIRED), NOMINAL), "0.8")
    _arm(panels[1], really(DESIRED), INK)
    _arm(panels[2], planar_arm(believed(fake), NOMINAL), "0.8")
    _arm(panels[2], really(fake), INK)
    _point(panels[2], fake, "fake pose", LEARNED, "D", (-20, -14))
    _miss(panels[1], really(DESIRED)[-1])
    texts = "healthy:\nhits", "damaged:\nmisses", "sent to a fake\npose: hits"
    for axes, text in zip(panels, texts, strict=True):
        _point(axes, DESIRED, "desired", NEUTRAL, "*", (5, 4))
        axes.set_title(text, fontweight="normal", loc="left")
    return figure


def _arm(axes: Axes, joints: np.ndarray, color: str) -> None:
    style = {"color": color, "linewidth": 3, "solid_capstyle": "round", "marker": "o"}
    axes.plot(*(joints + BASE).T, markersize=5, markerfacecolor="white", **style)


def _point(axes: Axes, at: np.ndarray, name: str, color: str, marker: str, offset) -> None:
    at = at + BASE
    axes.scatter(*at, s=45, marker=marker, color=color, zorder=4)
    axes.annotate(name, at, offset, textcoords="offset points", color=color)


def _miss(axes: Axes, tip: np.ndarray) -> None:
    axes.plot(*np.stack([tip + BASE, DESIRED + BASE]).T, color=FAILS, linestyle=":", linewidth=1.5)


NETS = Nets((3, 3, 1), (3, 3, 1), "boxes", (1.0,) * 6)  # one layer of each net
WIDE = 0.9  # of all neighbourhoods, in workspace coordinates: which is wider is searched for


def method() -> Figure:
    """What happens in an iteration, and how the cells lie in the workspace."""
    figure, (above, below) = plt.subplots(2, 1, figsize=(WIDTH, 6), height_ratios=[1.1, 1])
    _cycle(above)
    _nets(below)
    return figure


def _cycle(axes: Axes) -> None:
    blank(axes, 10, 9)
    box(axes, 1.7, 8, "desired\npose $u$")
    box(axes, 5.6, 8, "the nearest cell\nof each map", LEARNED)
    box(axes, 8.9, 5.6, "fake pose $\\theta'$", LEARNED)
    box(axes, 8.6, 3.2, "controller,\nas it always was")
    box(axes, 6, 1, "damaged arm")
    box(axes, 1.9, 1, "where it\nwent: $u'$")
    box(axes, 1.9, 4.4, "error\n$u - u'$", FAILS)
    arrow(axes, (2.55, 8), (3.95, 8))
    arrow(axes, (7.2, 7.8), (8.9, 6.05), bend=-0.25)
    arrow(axes, (8.85, 5.2), (8.75, 3.8))
    arrow(axes, (8.5, 2.6), (7.6, 1.2), bend=-0.2)
    arrow(axes, (4.35, 1), (2.95, 1))
    arrow(axes, (1.9, 1.6), (1.9, 3.8))
    arrow(axes, (1.75, 7.4), (1.85, 5.0))
    arrow(axes, (2.65, 4.4), (5.3, 7.4), FAILS, bend=0.2, width=2.5)
    axes.text(
        4.35,
        4.6,
        "corrects the cell,\nand its neighbours\nby the same change",
        color=FAILS,
        va="center",
    )


def _nets(axes: Axes) -> None:
    blank(axes, 10, 9.6)
    axes.text(2.6, 9.2, "supernet:\npositions", ha="center", va="center")
    axes.text(7.6, 9.2, "a subnet in each cell:\norientations", ha="center", va="center")
    winner = np.array([4]), np.array([4])
    learns = NETS.neighbourhood(*winner, *np.full((2, 1), WIDE))
    for y, error in zip((6.6, 2.4), BOTH, strict=True):
        name, color = error.kind, error.color
        shades = LinearSegmentedColormap.from_list(name, ["white", color])
        axes.text(-0.5, y, f"{name}\nmap", color=color, fontweight="bold", ha="center", va="center")
        arrow(axes, (2.95, y), (5.85, y), bend=-0.25)
        for x, cells, (g,), sign in zip(
            (2.6, 7.6), (NETS.w_k, NETS.w_kl), learns, ("$g_k$", "$g_{kl}$"), strict=True
        ):
            points = np.array([x, y]) + 1.7 * cells[:, :2]
            style = {"c": shades(np.round(g, 3)), "edgecolors": INK, "linewidths": 0.8}
            axes.scatter(*points.T, s=200, zorder=3, **style)
            axes.text(x, y - 1.75, f"neighbourhood {sign}", ha="center", va="top")


CELLS = regular_grid((9,))[:, 0]
WINNER, SIGMA = 6, 0.6  # of the neighbourhood, in workspace coordinates


def wanted(poses: np.ndarray) -> np.ndarray:
    """The commands of a damaged robot, not far from those of a healthy one: the poses."""
    return 0.94 * poses + 0.3


def increments() -> Figure:
    """Equations (4) and (7) at work in one dimension, after a single correction."""
    figure, panels = plt.subplots(1, 2, sharey=True, figsize=(WIDTH, 3.3))
    learns = np.exp(-0.5 * ((CELLS - CELLS[WINNER]) / SIGMA) ** 2)
    learned = wanted(CELLS[WINNER])  # the winner's new command
    values = CELLS + learns * (learned - CELLS)  # (4)
    changes = CELLS + learns * (learned - CELLS[WINNER])  # (7)
    texts = ("Ritter: all move\ntowards its new value", "improved: all move\nby its change")
    for axes, after, style, text in zip(
        panels, (values, changes), styles_of(["ritter", "improved"]).values(), texts, strict=True
    ):
        axes.plot(CELLS, CELLS, color="0.6", label="before the damage")
        axes.plot(CELLS, wanted(CELLS), color=INK, linestyle=(0, (5, 2)), label="what is right now")
        axes.vlines(CELLS, CELLS, after, color=style.color, linewidth=1, alpha=0.6)
        axes.scatter(CELLS, after, color=style.color, zorder=3, label="cells, corrected once")
        axes.annotate(
            "corrected here",
            (CELLS[WINNER], learned),
            (-14, 22),
            textcoords="offset points",
            ha="right",
            arrowprops={"arrowstyle": "-|>", "color": INK, "shrinkB": 5},
        )
        axes.set(xlabel="desired pose", ylim=(-1.15, 1.75))
        axes.set_title(text, fontweight="normal")
    panels[0].set_ylabel("command")
    legend_below(figure, panels[1], 2)
    return figure


START, END = 1.5, 0.3  # widths, in workspace coordinates
ITERATIONS = 200
STEP = 0.1  # of the width, in which visits are counted
VOLUME = 2.0**DIMENSIONS
POWERS = {"ritter": EXPONENTIAL, "improved": IMPROVED.width_power}
NAMES = {"ritter": "Ritter: exponential", "improved": "improved: equal visits"}


def schedule() -> Figure:
    """Equation (10) at work, far from the border of the workspace."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(WIDTH, 2.9))
    done = np.linspace(0, 1, 1001)
    for name, style in styles_of(POWERS).items():
        widths = fall(START, END, done, POWERS[name])
        left.plot(ITERATIONS * done, widths, label=NAMES[name], **style.line())
        iterations = ITERATIONS * STEP / np.abs(np.gradient(widths, done))  # spent at each width
        visits = iterations * expected_learning(widths, DIMENSIONS, VOLUME)
        right.plot(widths, visits, label=NAMES[name], **style.line())
    left.set(xlabel="iterations", ylabel="width of a neighbourhood", ylim=(0, None))
    right.set(xlabel="width", ylabel=f"visits of a cell for {STEP:g} of width", ylim=(0, None))
    legend_below(figure, left, 2)
    return figure


def draw(folder: Path) -> None:
    """Draw all of them into a folder."""
    with plt.rc_context(STYLE):
        for picture in (method, fake_pose, increments, schedule):
            paths = (folder / f"{picture.__name__}.{suffix}" for suffix in ("svg", "png"))
            save(picture(), *paths)


if __name__ == "__main__":
    draw(Path(__file__).parent)
