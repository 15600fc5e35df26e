"""The HTML page of a calibration: a single self-contained file, with drawings as SVG."""

from io import StringIO
from typing import Any
from warnings import catch_warnings, simplefilter

import numpy as np
from matplotlib import rc_context
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

from recalib.laboratory.report.summary import errors_table, notes, verdict
from recalib.laboratory.report.templates import UNITS, render
from recalib.laboratory.results import Results

COLOURS, GREY = {"before": "#D55E00", "after": "#0072B2"}, "#999"
WIDTH = 9.6  # inches
COLUMNS = 3
LONGEST = 0.12  # of the arm's reach: the drawn length of the largest error
LEAST = 1e-4  # mm or deg: smaller than any instrument resolves
LISTED = 15  # parameters, the most certain first
STYLE: dict[Any, Any] = {
    "axes.grid": True,
    "axes.spines.right": False,
    "axes.spines.top": False,
    "font.size": 9,
    "grid.color": "#e5e5e5",
    "savefig.dpi": 150,  # of rasterized points and arrows: thousands would slow a browser
    "svg.fonttype": "none",
    "svg.hashsalt": "recalib",  # makes the text of a drawing reproducible
}


@rc_context(STYLE)
def draw_errors(result: Results) -> str:
    """The cumulative distribution of errors, before and after."""
    kinds = result.calibration.estimate.noise.size
    figure, panels = figure_of(2.8, 1, kinds)
    for kind, (panel, (scale, unit)) in enumerate(zip(panels.flat, UNITS, strict=False)):
        panel.set(xlabel=f"cross-validated error [{unit}]", xscale="log")
        _plain(panel.xaxis)
        for name, numbers in _errors(result, kind, scale).items():
            panel.ecdf(np.maximum(numbers, LEAST), color=COLOURS[name], linewidth=1.5)
    panels[0, 0].set_ylabel("part of the rows")
    return svg_of(figure)


@rc_context(STYLE)
def draw_over_joints(result: Results) -> str:
    """Position errors over each joint's coordinate, before and after."""
    joints, arm = result.data.observations.joints[result.counted], result.arm
    rows = -(-len(arm.joints) // COLUMNS)
    figure, panels = figure_of(2.2 * rows, rows, COLUMNS, sharey=True)
    for panel in panels.flat[len(arm.joints) :]:
        panel.remove()
    for panel in panels[:, 0]:
        panel.set(ylabel="position error [mm]", yscale="log")
        _plain(panel.yaxis)
    for index, (joint, slides) in enumerate(zip(arm.joints, arm.slides, strict=True)):
        (scale, unit), panel = UNITS[0 if slides else 1], panels.flat[index]
        panel.set_xlabel(f"{joint} [{unit}]", parse_math=False)  # a name may have dollar signs
        for name, numbers in _errors(result, 0, 1e3).items():
            panel.scatter(
                scale * joints[:, index],
                np.maximum(numbers, LEAST),
                s=6,
                color=COLOURS[name],
                linewidth=0,
                rasterized=True,
            )
    return svg_of(figure)


@rc_context(STYLE)
def draw_arm(result: Results) -> tuple[str, float]:
    """The arm in a middle posture, from the side and from above, with positions and their errors.

    Everything is drawn in the arm's base. Also returns the magnification of the errors.
    """
    joints, positions = result.data.observations.joints[result.counted], result.positions
    middle = np.linalg.norm(joints - np.median(joints, axis=0), axis=1).argmin()
    skeleton = result.arm.skeleton(joints[[middle]])[0]
    residuals = {name: rows[:, :3] for name, rows in result.residuals.items()}
    reach = np.linalg.norm(skeleton, axis=1).max()
    longer = LONGEST * reach / np.linalg.norm(residuals["before"], axis=1).max()
    longer = float(f"{longer:.0e}")  # a round number
    figure, panels = figure_of(4.2, 1, 2)
    views = ("from the side", [0, 2]), ("from above", [0, 1])
    for panel, (title, axes) in zip(panels.flat, views, strict=True):
        across, up = ("xyz"[axis] for axis in axes)
        panel.set(title=title, xlabel=f"{across} [m]", ylabel=f"{up} [m]")
        panel.set_aspect("equal", "datalim")
        panel.plot(*skeleton[:, axes].T, "o-", color=GREY, linewidth=3)
        for name, rows in residuals.items():
            start, step = positions[:, axes].T, longer * rows[:, axes].T
            scales = {"angles": "xy", "scale_units": "xy", "scale": 1, "width": 0.003}
            panel.quiver(*start, *step, color=COLOURS[name], rasterized=True, **scales)
            panel.update_datalim((start + step).T)
        panel.autoscale_view()
    return svg_of(figure), longer


def _errors(result: Results, kind: int, scale: float) -> dict[str, np.ndarray]:
    """Errors (n,) before and after of position (kind 0) or orientation (kind 1), times a scale."""
    part = slice(3 * kind, 3 * kind + 3)
    return {
        name: scale * np.linalg.norm(rows[:, part], axis=1)
        for name, rows in result.residuals.items()
    }


def figure_of(
    height: float, rows: int, columns: int, sharey: bool = False
) -> tuple[Figure, np.ndarray]:
    """A figure of this height [inches], and its panels (rows, columns)."""
    figure = Figure((WIDTH, height))
    figure.subplots_adjust(0.07, 0.5 / height, 0.99, 1 - 0.3 / height, hspace=0.35)
    return figure, figure.subplots(rows, columns, sharey=sharey, squeeze=False)


def _plain(axis: Axis) -> None:
    """Label powers of ten as plain numbers, without minor ticks, which take a second to draw."""
    axis.set_major_formatter("{x:g}")
    axis.set_minor_locator(NullLocator())


def svg_of(figure: Figure) -> str:
    """The SVG element of a figure, for an HTML page."""
    text, metadata = StringIO(), dict.fromkeys(("Creator", "Date", "Format", "Type"))
    with catch_warnings():  # a browser has the letters that Matplotlib's font lacks
        simplefilter("ignore", UserWarning)
        figure.savefig(text, format="svg", metadata=metadata)
    return text.getvalue()[text.getvalue().index("<svg") :]


def page_of(result: Results) -> bytes:
    parameters = result.identified
    decided = [parameter for parameter in parameters if parameter["decided_by"] == "data"]
    decided.sort(key=lambda parameter: -abs(parameter["value"]) / parameter["deviation"])
    arm_drawing, longer = draw_arm(result)
    return render(
        "page.html.j2",
        result=result,
        verdict=verdict(result),
        notes=notes(result),
        errors=errors_table(result),
        errors_drawing=draw_errors(result),
        joints_drawing=draw_over_joints(result),
        arm_drawing=arm_drawing,
        longer=longer,
        colours={name: COLOURS[name] for name in result.residuals},
        parameters=decided[:LISTED],
        decided=len(decided),
        undecided=len(parameters) - len(decided),
    ).encode()
