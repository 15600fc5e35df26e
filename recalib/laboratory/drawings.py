"""The drawings of the page of a calibration, as SVG."""

import io

import numpy as np
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure

from recalib.identification.validation import NOTHING
from recalib.laboratory.calibrate import Calibrated
from recalib.laboratory.summary import UNITS

BEFORE = {"color": "#D55E00", "label": "before"}
AFTER = {"color": "#0072B2", "label": "after"}
WIDTH = 8.6  # inches
MANY = 300  # points from which on they are drawn as a picture: the file would grow large
LONGEST = 0.12  # of the arm's reach: so long is the largest miss drawn
LEAST = 1e-4  # mm or deg: below that nobody measures


def draw_errors(result: Calibrated) -> str:
    """What part of the rows has at most which error, before and after."""
    kinds = result.calibration.estimate.noise.size
    figure = Figure((WIDTH, 3.2), layout="constrained")
    for axes, (scale, unit), kind in zip(
        np.atleast_1d(figure.subplots(1, kinds)), UNITS, range(kinds), strict=False
    ):
        for label, style in _before_and_after(result):
            missed = result.missed(label)[:, 3 * kind : 3 * kind + 3]
            errors = np.maximum(scale * np.linalg.norm(missed, axis=1), LEAST)
            axes.ecdf(errors, linewidth=2, **style)
        axes.set_xscale("log")
        axes.set_xlabel(f"error on rows that were not learned from [{unit}]")
        axes.xaxis.set_major_formatter("{x:g}")
        _tidy(axes)
    figure.axes[0].set_ylabel("part of the rows")
    figure.axes[0].legend(frameon=False, loc="upper left")
    return _svg(figure)


def draw_over_joints(result: Calibrated) -> str:
    """Position errors over each joint's coordinate, before and after."""
    joints, slides = result.seen.joints[result.counted], result.arm.slides
    columns = 3
    rows = -(-joints.shape[1] // columns)
    figure = Figure((WIDTH, 2.2 * rows), layout="constrained")
    grid = np.ravel(figure.subplots(rows, columns, sharey=True, squeeze=False))
    for axes in grid[joints.shape[1] :]:
        axes.set_visible(False)
    for axes, joint, column, slide in zip(grid, result.arm.joints, joints.T, slides, strict=False):
        scale, unit = UNITS[0] if slide else UNITS[1]
        for label, style in _before_and_after(result):
            errors = 1e3 * np.linalg.norm(result.missed(label)[:, :3], axis=1)
            axes.plot(
                scale * column,
                np.maximum(errors, LEAST),
                ".",
                markersize=3,
                rasterized=len(column) > MANY,
                **style,
            )
        axes.set_yscale("log")
        axes.minorticks_off()  # on so many axes, they would be half of the work
        axes.yaxis.set_major_formatter("{x:g}")
        axes.set_xlabel(f"{joint} [{unit}]", fontsize=9)
        _tidy(axes)
    figure.supylabel("position error [mm]", fontsize=10)
    figure.legend(
        *grid[0].get_legend_handles_labels(),
        loc="outside upper left",  # inside it would lie on rows
        ncols=2,
        frameon=False,
        fontsize=9,
        markerscale=3,
        handletextpad=0.2,
    )
    return _svg(figure)


def draw_arm(result: Calibrated) -> str:
    """The arm in a middle posture, from the side and from above, with measured points and misses.

    Everything is drawn in the arm's base.
    """
    calibration, seen = result.calibration, result.seen[result.counted]
    frames = calibration.frames
    back = np.linalg.inv(frames.base)
    places = _in_base(back, calibration.seen(seen.joints, seen.targets)[:, :3, 3])
    middle = np.linalg.norm(seen.joints - np.median(seen.joints, axis=0), axis=1).argmin()
    skeleton = result.arm.skeleton(seen.joints[[middle]])[0]
    reach = np.linalg.norm(skeleton, axis=1).max()
    figure = Figure((WIDTH, 4.4), layout="constrained")
    grid = figure.subplots(1, 2)
    before = result.missed(NOTHING)[:, :3]
    longer = LONGEST * reach / np.linalg.norm(before, axis=1).max()
    longer = float(f"{longer:.0e}")  # a round number
    for axes, (across, up) in zip(grid, ((0, 2), (0, 1)), strict=True):
        axes.plot(
            skeleton[:, across], skeleton[:, up], "-o", color="0.6", linewidth=4, markersize=6
        )
        for label, style in _before_and_after(result):
            misses = longer * result.missed(label)[:, :3] @ back[:3, :3].T
            axes.quiver(
                places[:, across],
                places[:, up],
                misses[:, across],
                misses[:, up],
                angles="xy",
                scale_units="xy",
                scale=1,
                width=0.003,
                rasterized=len(places) > MANY,
                **style,
            )
        axes.set_aspect("equal", adjustable="datalim")
        axes.set_xlabel(f"{'xyz'[across]} [m]")
        axes.set_ylabel(f"{'xyz'[up]} [m]")
        axes.margins(0.1)
        _tidy(axes)
    grid[0].set_title("from the side", loc="left", fontsize=10)
    grid[1].set_title("from above", loc="left", fontsize=10)
    grid[0].legend(
        frameon=False, fontsize=9, title=f"misses, {longer:g} times as long", title_fontsize=9
    )
    return _svg(figure)


def _before_and_after(result: Calibrated):
    yield NOTHING, BEFORE
    if result.worthwhile:
        yield result.validation.chosen, AFTER


def _in_base(back: np.ndarray, points: np.ndarray) -> np.ndarray:
    return points @ back[:3, :3].T + back[:3, 3]


def _tidy(axes) -> None:
    axes.spines[["top", "right"]].set_visible(False)
    axes.grid(color="0.92")
    axes.set_axisbelow(True)
    axes.tick_params(labelsize=9)


def _svg(figure: Figure) -> str:
    """The drawing as an element to stand in a page."""
    text = io.StringIO()
    FigureCanvasSVG(figure).print_svg(text, metadata={"Date": None})
    return text.getvalue()[text.getvalue().index("<svg") :]
