"""The entities of a recording: what stands still is static, the rest is sent as columns over time.

    /about, /beside                the texts of the two tabs
    /workspace, /desired           the box of positions, and the shown test poses in it
    /<learner>/<robot>             the meshes of the real arm that this learner moves
    /<learner>/links               where its links are
    /<learner>/believed            the arm that its controller believes in, as a skeleton
    /<learner>/wrong               where the arm is not what its controller believes
    /<learner>/target              the pose that the arm is sent to, and how far off it ends up
    /<learner>/achieved            where the real arm lands
    /<learner>/miss                lines to there from the desired positions
    /<learner>/measured            what is measured there, where that is disturbed
    /<learner>/map/cells           the supernet's cells, lit by the neighbourhood of the last winner
    /<learner>/map/corrections     how far each cell has learned to move its position command
    /errors/<quantity>/<learner>   mean errors over all test poses
    /errors/<quantity>/paper       the published initial error, where it is meant

Timeline `moves` counts the robot's moves while it learns. Timeline `time` runs through the three
acts of `story.Motion`; what is measured during learning stands on both.
"""

from collections.abc import Mapping

import numpy as np
import rerun as rr

from recalib.nominal.poses import POSITION, Workspace
from recalib.study.recording.clocks import clocks, measurements
from recalib.study.recording.colours import GREY, WHITE, of_misses
from recalib.study.recording.story import Motion, Watched

AXIS = 0.22  # length of the axes of a pose, in units of `unit_of`


def unit_of(workspace: Workspace) -> float:
    """m: half a side of the workspace, on average, by which everything drawn is sized."""
    return float(workspace.half_ranges[POSITION].mean())


def log_surroundings(
    rec: rr.RecordingStream, workspace: Workspace, desired: np.ndarray, texts: Mapping[str, str]
) -> None:
    """The texts by entity, the workspace's box and the desired poses (pose, 4, 4)."""
    rec.log("/", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
    for entity, text in texts.items():
        rec.log(entity, rr.TextDocument(text, media_type="text/markdown"), static=True)
    centre, half_sizes, unit = (
        workspace.centre[:3, 3],
        workspace.half_ranges[POSITION],
        unit_of(workspace),
    )
    edges = rr.components.FillMode.MajorWireframe
    box = rr.Boxes3D(
        centers=[centre], half_sizes=[half_sizes], colors=GREY, radii=0.004 * unit, fill_mode=edges
    )
    rec.log("workspace", box, static=True)
    rec.log(
        "desired",
        rr.LineStrips3D(axes_of(desired, AXIS * unit), colors=WHITE, radii=0.0075 * unit),
        static=True,
    )


def send_landings(
    rec: rr.RecordingStream, learner: str, unit: float, watched: Watched, motion: Motion
) -> None:
    """Achieved frames, and the misses as lines in a colour that tells their length."""
    clock, rows = measurements(watched, motion)
    achieved = watched.achieved[rows]
    starts = np.broadcast_to(watched.desired[:, :3, 3], achieved[..., :3, 3].shape)
    lines = np.stack([starts, achieved[..., :3, 3]], axis=-2).reshape(-1, 2, 3)
    axes = axes_of(achieved.reshape(-1, 4, 4), AXIS * unit)
    colours = of_misses(watched.misses[rows].ravel())
    for entity, strips, tints, radius in (
        (f"{learner}/achieved", axes, np.repeat(colours, 3, axis=0), 0.014 * unit),
        (f"{learner}/miss", lines, colours, 0.03 * unit),
    ):
        columns = rr.LineStrips3D.columns(strips=strips, colors=tints)
        rec.send_columns(entity, clock, columns.partition([len(strips) // len(rows)] * len(rows)))
        rec.log(entity, rr.LineStrips3D.from_fields(radii=radius), static=True)


def send_target(
    rec: rr.RecordingStream,
    workspace: Workspace,
    learner: str,
    when: tuple[str, str],
    watched: Watched,
    motion: Motion,
) -> None:
    """The pose that the arm is sent to, and above the workspace words for how far off it is.

    Args:
        when: words for the first and the third act.
    """
    poses, moves = len(watched.desired), watched.history.moves
    caption, target = f"{learner}/target/caption", f"{learner}/target/pose"
    above = workspace.centre[:3, 3] + [0, 0, 1.4 * workspace.half_ranges[2]]
    rec.log(caption, rr.Points3D([above], radii=0, colors=WHITE), static=True)
    dot = rr.Points3D.from_fields(radii=0.052 * unit_of(workspace), colors=WHITE)
    rec.log(target, dot, static=True)
    seconds, visited, captions = [], [], []
    for act, (measurement, words) in enumerate(zip((0, -1), when, strict=True)):
        for pose in range(poses):
            seconds += [motion.departures[act, pose], motion.arrivals[act, pose]]
            visited += [pose, pose]
            captions += [words, f"{words}: {_off(watched, measurement, pose)}"]
    acts = [rr.TimeColumn("time", duration=seconds)]
    progress = [
        f"after {done} moves: {_off(watched, row, poses - 1)}" for row, done in enumerate(moves)
    ]
    for clock, where, words in (
        (acts, visited, captions),
        (clocks(watched, motion)[1], [poses - 1] * len(progress), progress),
    ):
        rec.send_columns(caption, clock, rr.Points3D.columns(labels=words))
        there = rr.Points3D.columns(positions=watched.desired[where, :3, 3])
        rec.send_columns(target, clock, there)


def axes_of(poses: np.ndarray, length: float) -> np.ndarray:
    """The axes of poses (pose, 4, 4) as lines (pose x axis, 2, 3) of this length [m]."""
    origins = np.repeat(poses[:, None, :3, 3], 3, axis=1)
    tips = origins + length * np.swapaxes(poses[:, :3, :3], 1, 2)
    return np.stack([origins, tips], axis=2).reshape(-1, 2, 3)


def _off(watched: Watched, measurement: int, pose: int) -> str:
    centimetres, degrees = (
        100 * watched.misses[measurement, pose],
        np.degrees(watched.tilts[measurement, pose]),
    )
    return f"{centimetres:.1f} cm and {degrees:.1f}° off"
