"""The drawings of the page of a calibration, as SVG."""

import numpy as np

from recalib.identification.validation import NOTHING
from recalib.laboratory.calibrate import Calibrated
from recalib.laboratory.panels import Axis, Panel, drawing
from recalib.laboratory.summary import UNITS

BEFORE, AFTER, GREY = "#D55E00", "#0072B2", "#999"
WIDTH = 960  # of a drawing, in units of which a page has about as many
COLUMNS = 3
LONGEST = 0.12  # of the arm's reach: so long is the largest error drawn
LEAST = 1e-4  # mm or deg: below that nobody measures


def draw_errors(result: Calibrated) -> str:
    """What part of the rows has at most which error, before and after."""
    kinds, panels = result.calibration.estimate.noise.size, []
    for kind, (scale, unit) in enumerate(UNITS[:kinds]):
        errors = {
            colour: np.sort(scale * np.linalg.norm(missed[:, 3 * kind : 3 * kind + 3], axis=1))
            for colour, missed in _before_and_after(result)
        }
        label = f"error on rows that were not learned from [{unit}]"
        axes = Axis(label, [*errors.values()], LEAST), Axis("part of the rows", [0, 1])
        panel = Panel((WIDTH / kinds, 280), axes)
        for colour, numbers in errors.items():
            parts = np.linspace(0, 1, len(numbers) + 1)
            panel.line(numbers.repeat(2), parts.repeat(2)[1:-1], colour, 2)
        panels.append(panel)
    return drawing(panels, kinds)


def draw_over_joints(result: Calibrated) -> str:
    """Position errors over each joint's coordinate, before and after."""
    joints, arm, panels = result.seen.joints[result.counted], result.arm, []
    errors = {
        colour: 1e3 * np.linalg.norm(missed[:, :3], axis=1)
        for colour, missed in _before_and_after(result)
    }
    up = Axis("position error [mm]", [*errors.values()], LEAST)
    for joint, slides, column in zip(arm.joints, arm.slides, joints.T, strict=True):
        scale, unit = UNITS[0] if slides else UNITS[1]
        panel = Panel((WIDTH / COLUMNS, 220), [Axis(f"{joint} [{unit}]", scale * column), up])
        for colour, numbers in errors.items():
            panel.dots(scale * column, numbers, colour, 4)
        panels.append(panel)
    return drawing(panels, COLUMNS)


def draw_arm(result: Calibrated) -> tuple[str, float]:
    """The arm in a middle posture, from the side and from above, with measured points and errors.

    Everything is drawn in the arm's base. Returns by how many times errors are drawn too long.
    """
    seen, frames = result.seen[result.counted], result.calibration.frames
    joints, back = seen.joints, np.linalg.inv(frames.base)
    poses = back @ result.calibration.seen(joints, seen.targets)
    middle = np.linalg.norm(joints - np.median(joints, axis=0), axis=1).argmin()
    skeleton = result.arm.skeleton(joints[[middle]])[0]
    errors = {
        colour: missed[:, :3] @ back[:3, :3].T for colour, missed in _before_and_after(result)
    }
    reach = np.linalg.norm(skeleton, axis=1).max()
    longer = LONGEST * reach / np.linalg.norm(errors[BEFORE], axis=1).max()
    longer = float(f"{longer:.0e}")  # a round number
    places = poses[:, :3, 3]
    ends = {colour: places + longer * error for colour, error in errors.items()}
    drawn, panels = np.concatenate([skeleton, *ends.values()]), []
    for title, sides in (("from the side", (0, 2)), ("from above", (0, 1))):
        axes = [Axis(f"{'xyz'[side]} [m]", drawn[:, side]) for side in sides]
        panel = Panel((WIDTH / 2, 420), axes, title, alike=True)
        panel.line(*skeleton[:, sides].T, GREY, 5)
        panel.dots(*skeleton[:, sides].T, GREY, 10)
        for colour, end in ends.items():
            panel.spikes(places[:, sides], end[:, sides], colour)
        panels.append(panel)
    return drawing(panels, 2), longer


def _before_and_after(result: Calibrated):
    """Colours, each with what rows were missed by (n, 3) m or (n, 6) m and rad."""
    yield BEFORE, result.missed(NOTHING)
    if result.worthwhile:
        yield AFTER, result.missed(result.validation.chosen)
