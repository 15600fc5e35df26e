"""What a fake pose is: an arm in a plane, healthy, damaged, and damaged but recalibrated."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.optimize import root

from recalib.study.evidence.results import Evidence
from recalib.study.plots.explained.sketch import INK, LEARNED, blank, planar_arm
from recalib.study.plots.palette import FAILS, NEUTRAL
from recalib.study.plots.style import title

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


def fake_pose(evidence: Evidence) -> Figure:
    """Where an arm goes that is sent to the desired pose, and to the fake one."""
    figure, panels = plt.subplots(1, 3, figsize=(10.5, 2.8))
    fake = np.round(root(lambda pose: really(pose)[-1] - DESIRED, DESIRED).x, 9)
    for axes in panels:
        blank(axes, 2.35, 1.15)
        axes.axhline(BASE[1] - 0.06, color=INK, linewidth=0.8)
    _arm(panels[0], planar_arm(believed(DESIRED), NOMINAL), INK)
    _arm(panels[1], planar_arm(believed(DESIRED), NOMINAL), "0.8")
    _arm(panels[1], really(DESIRED), INK)
    _arm(panels[2], planar_arm(believed(fake), NOMINAL), "0.8")
    _arm(panels[2], really(fake), INK)
    _point(panels[2], fake, "fake pose", LEARNED, "D", (-26, -20))
    _miss(panels[1], really(DESIRED)[-1])
    texts = (
        "healthy: it goes where it is sent",
        "damaged: it misses",
        "damaged, sent to a fake pose: it hits",
    )
    for axes, text in zip(panels, texts, strict=True):
        _point(axes, DESIRED, "desired pose", NEUTRAL, "*", (7, 6))
        axes.set_title(text, fontweight="normal", loc="center")
    title(
        figure,
        "The controller is not touched: only the pose that it is sent changes",
        "black: the real arm; grey: the arm that the controller believes in",
    )
    return figure


def _arm(axes: Axes, joints: np.ndarray, color: str) -> None:
    style = {"color": color, "linewidth": 5, "solid_capstyle": "round", "marker": "o"}
    axes.plot(*(joints + BASE).T, markersize=9, markerfacecolor="white", **style)


def _point(axes: Axes, at: np.ndarray, name: str, color: str, marker: str, offset) -> None:
    at = at + BASE
    axes.scatter(*at, s=110, marker=marker, color=color, zorder=4)
    axes.annotate(name, at, offset, textcoords="offset points", color=color, fontsize=10)


def _miss(axes: Axes, tip: np.ndarray) -> None:
    axes.plot(*np.stack([tip + BASE, DESIRED + BASE]).T, color=FAILS, linestyle=":", linewidth=2)
