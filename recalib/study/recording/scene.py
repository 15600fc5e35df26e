"""The entities of a recording: what stands still is static, the rest is sent as columns over time.

    /about                         the text panel
    /workspace, /desired           the box of positions, and the shown test poses in it
    /damaged, /nominal             the real arm, and as a ghost what the controller believes in
    /target                        the pose that the arm is sent to, and how far off it ends up
    /<learner>/achieved            where the real arm lands
    /<learner>/miss                lines to there from the desired positions
    /<learner>/map/cells           the supernet's cells, lit by the neighbourhood of the last winner
    /<learner>/map/corrections     how far each cell has learned to move its position command
    /errors/<quantity>/<learner>   mean errors over all test poses
    /log10/<quantity>/<learner>    their logarithms, beside the published initial error

Timeline `iteration` counts learning iterations. Timeline `time` runs through the three acts of
`story.Motion`; what is measured during learning stands on both.
"""

from collections.abc import Mapping

import numpy as np
import rerun as rr

from recalib.nominal.poses import POSITION, Workspace
from recalib.study.measured import ERRORS, UNITS
from recalib.study.recording.story import Motion, Watched

PUBLISHED = "paper"  # the entity's name beside those of the learners
LEAST_ERROR = 1e-3
LEARNER_COLOURS = ((255, 176, 0), (120, 170, 255), (0, 200, 160), (230, 130, 190))
WHITE, GREY, VIOLET = (255, 255, 255), (140, 150, 160), (200, 140, 255)
DIM, LIT = np.array([95, 105, 125]), np.array([255, 214, 90])  # cells far from the winner, at it
NEAR, FAR = np.array([0, 200, 160]), np.array([255, 90, 40])  # different in brightness, too
NEAREST, FARTHEST = 1e-3, 0.1  # m: the misses that are drawn in these colours
AXIS = 0.22  # length of the axes of a pose, in units of `unit_of`


def unit_of(workspace: Workspace) -> float:
    """m: half a side of the workspace, on average, by which everything drawn is sized."""
    return float(workspace.half_ranges[POSITION].mean())


def log_surroundings(
    rec: rr.RecordingStream, workspace: Workspace, desired: np.ndarray, about: str
) -> None:
    """The text, the workspace's box and the desired poses (pose, 4, 4)."""
    rec.log("/", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
    rec.log("about", rr.TextDocument(about, media_type="text/markdown"), static=True)
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
        rr.LineStrips3D(_axes(desired, AXIS * unit), colors=WHITE, radii=0.0075 * unit),
        static=True,
    )


def send_errors(
    rec: rr.RecordingStream, learner: str, colour: tuple, watched: Watched, motion: Motion
) -> None:
    """Mean errors over all test poses, and their logarithms, as the viewer's plots are linear."""
    clock, rows = _measurements(watched, motion)
    results = watched.history.columns()
    for quantity in ERRORS:
        values = results[quantity][rows]
        rec.send_columns(f"errors/{quantity}/{learner}", clock, rr.Scalars.columns(scalars=values))
        rec.send_columns(
            f"log10/{quantity}/{learner}", clock, rr.Scalars.columns(scalars=logarithm(values))
        )
        rec.log(
            f"log10/{quantity}/{learner}",
            rr.SeriesLines(names=learner, colors=colour, widths=3),
            static=True,
        )


def send_published(
    rec: rr.RecordingStream, published: Mapping[str, float], watched: Watched, motion: Motion
) -> None:
    """The published initial errors, where there are any, as straight lines in the plots."""
    clock, rows = _measurements(watched, motion)
    for quantity, unit in zip(ERRORS, UNITS, strict=True):
        if quantity in published:
            entity, value = f"log10/{quantity}/{PUBLISHED}", published[quantity]
            line = np.full(len(rows), np.log10(value))
            rec.send_columns(entity, clock, rr.Scalars.columns(scalars=line))
            name = f"the paper, before: {value} {unit}"
            rec.log(entity, rr.SeriesLines(names=name, colors=GREY, widths=1), static=True)


def logarithm(errors: np.ndarray) -> np.ndarray:
    """Decimal logarithms of errors in cm or degrees.

    They end at a thousandth: an intact robot has no error at all.
    """
    return np.log10(np.maximum(errors, LEAST_ERROR))


def send_landings(
    rec: rr.RecordingStream, learner: str, unit: float, watched: Watched, motion: Motion
) -> None:
    """Achieved frames, and the misses as lines in a colour that tells their length."""
    clock, rows = _measurements(watched, motion)
    achieved = watched.achieved[rows]
    starts = np.broadcast_to(watched.desired[:, :3, 3], achieved[..., :3, 3].shape)
    lines = np.stack([starts, achieved[..., :3, 3]], axis=-2).reshape(-1, 2, 3)
    axes = _axes(achieved.reshape(-1, 4, 4), AXIS * unit)
    colours = _colours(watched.misses[rows].ravel())
    for entity, strips, tints, radius in (
        (f"{learner}/achieved", axes, np.repeat(colours, 3, axis=0), 0.0075 * unit),
        (f"{learner}/miss", lines, colours, 0.019 * unit),
    ):
        columns = rr.LineStrips3D.columns(strips=strips, colors=tints)
        rec.send_columns(entity, clock, columns.partition([len(strips) // len(rows)] * len(rows)))
        rec.log(entity, rr.LineStrips3D.from_fields(radii=radius), static=True)


def send_map(
    rec: rr.RecordingStream, learner: str, unit: float, watched: Watched, motion: Motion
) -> None:
    """The supernet's cells, brighter and larger the more they learned last.

    Their corrections are true to scale.
    """
    clock, rows = _measurements(watched, motion)
    each = [len(watched.centres)] * len(rows)
    weights = watched.weights[rows].ravel()
    light = (DIM + weights[:, None] * (LIT - DIM)).astype(np.uint8)
    cells = rr.Points3D.columns(radii=(0.022 + 0.038 * weights) * unit, colors=light)
    arrows = rr.Arrows3D.columns(vectors=watched.corrections[rows].reshape(-1, 3))
    rec.send_columns(f"{learner}/map/cells", clock, cells.partition(each))
    rec.send_columns(f"{learner}/map/corrections", clock, arrows.partition(each))
    rec.log(f"{learner}/map/cells", rr.Points3D(watched.centres), static=True)
    still = rr.Arrows3D.from_fields(origins=watched.centres, radii=0.011 * unit, colors=VIOLET)
    rec.log(f"{learner}/map/corrections", still, static=True)


def send_target(
    rec: rr.RecordingStream, workspace: Workspace, watched: Watched, motion: Motion
) -> None:
    """The pose that the arm is sent to, and above the workspace words for how far off it is."""
    poses, iterations = len(watched.desired), watched.history.iterations
    above = workspace.centre[:3, 3] + [0, 0, 1.4 * workspace.half_ranges[2]]
    rec.log("target/caption", rr.Points3D([above], radii=0, colors=WHITE), static=True)
    rec.log(
        "target/pose",
        rr.Points3D.from_fields(radii=0.052 * unit_of(workspace), colors=WHITE),
        static=True,
    )
    seconds, visited, captions = [], [], []
    for act, (measurement, when) in enumerate([(0, "before"), (-1, "after")]):
        for pose in range(poses):
            seconds += [motion.departures[act, pose], motion.arrivals[act, pose]]
            visited += [pose, pose]
            captions += [
                f"{when} recalibration",
                f"{when} recalibration: {_off(watched, measurement, pose)}",
            ]
    acts = [rr.TimeColumn("time", duration=seconds)]
    learning = [
        rr.TimeColumn("iteration", sequence=iterations),
        rr.TimeColumn("time", duration=motion.learning),
    ]
    progress = [
        f"iteration {done}: {_off(watched, row, poses - 1)}" for row, done in enumerate(iterations)
    ]
    for clock, where, words in (
        (acts, visited, captions),
        (learning, [poses - 1] * len(progress), progress),
    ):
        rec.send_columns("target/caption", clock, rr.Points3D.columns(labels=words))
        rec.send_columns(
            "target/pose", clock, rr.Points3D.columns(positions=watched.desired[where, :3, 3])
        )


def _measurements(watched: Watched, motion: Motion) -> tuple[list[rr.TimeColumn], np.ndarray]:
    """Time columns of what is measured, and its rows in them.

    The first and the last measurement stand twice, so that on `time` they also fill the acts before
    and after learning.
    """
    rows = np.concatenate([[0], np.arange(len(motion.learning)), [-1]])
    seconds = np.concatenate([[0], motion.learning, [motion.end]])
    iterations = watched.history.iterations[rows]
    return [
        rr.TimeColumn("iteration", sequence=iterations),
        rr.TimeColumn("time", duration=seconds),
    ], rows


def _axes(poses: np.ndarray, length: float) -> np.ndarray:
    """The axes of poses (pose, 4, 4) as lines (pose x axis, 2, 3) of this length [m]."""
    origins = np.repeat(poses[:, None, :3, 3], 3, axis=1)
    tips = origins + length * np.swapaxes(poses[:, :3, :3], 1, 2)
    return np.stack([origins, tips], axis=2).reshape(-1, 2, 3)


def _colours(misses: np.ndarray) -> np.ndarray:
    """Colours (n, 3) of misses (n,) in m, on a logarithmic scale."""
    share = np.log(np.clip(misses, NEAREST, FARTHEST) / NEAREST) / np.log(FARTHEST / NEAREST)
    return (NEAR + share[:, None] * (FAR - NEAR)).astype(np.uint8)


def _off(watched: Watched, measurement: int, pose: int) -> str:
    centimetres, degrees = (
        100 * watched.misses[measurement, pose],
        np.degrees(watched.tilts[measurement, pose]),
    )
    return f"{centimetres:.1f} cm and {degrees:.1f}° off"
