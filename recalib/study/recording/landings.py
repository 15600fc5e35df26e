"""Where the arm lands instead of the desired poses, and how measurements scatter about it."""

import numpy as np
import rerun as rr

from recalib.study.recording.colours import MEASURED, of_misses
from recalib.study.recording.scene import AXIS, Scene, axes_of, unit_of
from recalib.study.recording.watched import Watched

VISIBLE = 0.01  # m: measurements that scatter less are drawn enlarged


def send_landings(scene: Scene) -> None:
    """Achieved frames, and the misses as lines in a colour that tells their length."""
    watched, unit = scene.watched, unit_of(scene.workspace)
    clock, rows = scene.motion.throughout()
    achieved, poses = watched.achieved[rows], len(watched.desired)
    starts = np.broadcast_to(watched.desired[:, :3, 3], achieved[..., :3, 3].shape)
    misses = np.stack([starts, achieved[..., :3, 3]], axis=-2).reshape(-1, 2, 3)
    axes = axes_of(achieved.reshape(-1, 4, 4), AXIS * unit)
    colours = of_misses(watched.misses[rows].ravel())
    lines = rr.LineStrips3D.columns(strips=axes, colors=np.repeat(colours, 3, axis=0))
    scene.send("achieved", clock, lines, 3 * poses)
    scene.send("miss", clock, rr.LineStrips3D.columns(strips=misses, colors=colours), poses)
    scene.log("achieved", rr.LineStrips3D.from_fields(radii=0.014 * unit))
    scene.log("miss", rr.LineStrips3D.from_fields(radii=0.03 * unit))


def send_scatter(scene: Scene) -> None:
    """Lines from where the arm lands to what was measured there: noise, outliers, repeatability."""
    watched = scene.watched
    clock, rows = scene.motion.throughout()
    poses, repeated, _ = watched.scatter.shape
    landed = np.repeat(watched.achieved[rows, :, None, :3, 3], repeated, axis=2)
    ends = landed + enlarged(watched) * watched.scatter
    lines = np.stack([landed, ends], axis=-2).reshape(-1, 2, 3)
    scene.send("measured", clock, rr.LineStrips3D.columns(strips=lines), poses * repeated)
    style = rr.LineStrips3D.from_fields(radii=0.009 * unit_of(scene.workspace), colors=MEASURED)
    scene.log("measured", style)


def enlarged(watched: Watched) -> int:
    """How many times as large the errors of measurements are drawn to be visible: 1, 10, ..."""
    spread, times = np.sqrt(np.square(watched.scatter).sum(axis=-1).mean()), 1
    while 0 < spread * times < VISIBLE:
        times *= 10
    return times
