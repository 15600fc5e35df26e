"""The drawings of the page of a calibration, as SVG."""

import numpy as np

from recalib.laboratory.calibrate import Calibrated
from recalib.laboratory.panels import Axis, Panel, drawing
from recalib.laboratory.summary import UNITS

COLOURS, GREY = {"before": "#D55E00", "after": "#0072B2"}, "#999"
WIDTH = 960  # of a drawing, in units; a page has about as many
COLUMNS = 3
LONGEST = 0.12  # of the arm's reach: so long is the largest error drawn
LEAST = 1e-4  # mm or deg: below that nobody measures


def draw_errors(result: Calibrated) -> str:
    """What part of the rows has at most which error, before and after."""
    kinds, panels = result.calibration.estimate.noise.size, []
    for kind, (scale, unit) in enumerate(UNITS[:kinds]):
        errors = _errors(result, kind, scale)
        label = f"error on rows that were not learned from [{unit}]"
        axes = Axis(label, [*errors.values()], LEAST), Axis("part of the rows", [0, 1])
        panel = Panel((WIDTH / kinds, 280), axes)
        for name, numbers in errors.items():
            parts = np.linspace(0, 1, len(numbers) + 1)
            panel.line(np.sort(numbers).repeat(2), parts.repeat(2)[1:-1], COLOURS[name], 2)
        panels.append(panel)
    return drawing(panels, kinds)


def draw_over_joints(result: Calibrated) -> str:
    """Position errors over each joint's coordinate, before and after."""
    joints, arm, panels = result.observations.joints[result.counted], result.arm, []
    errors = _errors(result, 0, 1e3)
    up = Axis("position error [mm]", [*errors.values()], LEAST)
    for joint, slides, column in zip(arm.joints, arm.slides, joints.T, strict=True):
        scale, unit = UNITS[0] if slides else UNITS[1]
        panel = Panel((WIDTH / COLUMNS, 220), [Axis(f"{joint} [{unit}]", scale * column), up])
        for name, numbers in errors.items():
            panel.dots(scale * column, numbers, COLOURS[name], 4)
        panels.append(panel)
    return drawing(panels, COLUMNS)


def draw_arm(result: Calibrated) -> tuple[str, float]:
    """The arm in a middle posture, from the side and from above, with positions and their errors.

    Everything is drawn in the arm's base. Returns by how many times errors are drawn too long.
    """
    joints, positions = result.observations.joints[result.counted], result.positions
    middle = np.linalg.norm(joints - np.median(joints, axis=0), axis=1).argmin()
    skeleton = result.arm.skeleton(joints[[middle]])[0]
    residuals = {name: its[:, :3] for name, its in result.residuals.items()}
    reach = np.linalg.norm(skeleton, axis=1).max()
    longer = LONGEST * reach / np.linalg.norm(residuals["before"], axis=1).max()
    longer = float(f"{longer:.0e}")  # a round number
    ends = {name: positions + longer * its for name, its in residuals.items()}
    drawn, panels = np.concatenate([skeleton, *ends.values()]), []
    for title, sides in (("from the side", (0, 2)), ("from above", (0, 1))):
        axes = [Axis(f"{'xyz'[side]} [m]", drawn[:, side]) for side in sides]
        panel = Panel((WIDTH / 2, 420), axes, title, alike=True)
        across, up = skeleton[:, sides].T
        panel.line(across, up, GREY, 5)
        panel.dots(across, up, GREY, 10)
        for name, end in ends.items():
            panel.spikes(positions[:, sides], end[:, sides], COLOURS[name])
        panels.append(panel)
    return drawing(panels, 2), longer


def _errors(result: Calibrated, kind: int, scale: float) -> dict[str, np.ndarray]:
    """Errors (n,) before and after, of position (kind 0) or orientation (1), times a scale."""
    part = slice(3 * kind, 3 * kind + 3)
    return {
        name: scale * np.linalg.norm(its[:, part], axis=1) for name, its in result.residuals.items()
    }
