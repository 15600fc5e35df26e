"""What was measured while the arm learned: errors, landings and their scatter, cells of a map."""

from collections.abc import Mapping, Sequence

import numpy as np
import rerun as rr

from replication.recording.colours import GREY, MEASURED, NOMINAL, REACHED
from replication.recording.scene import AXIS, Scene, axes_of, unit_of
from replication.recording.watched import MapCells, Watched
from replication.training.measured import ERRORS, UNITS

PUBLISHED = "paper"  # the entity's name beside those of the learners
VISIBLE = 0.01  # m: measurements that scatter less are drawn enlarged


def send_errors(scene: Scene, colour: Sequence[int]) -> None:
    """Mean errors over all test poses."""
    results = scene.watched.history.columns()
    # a few moves in a moment are no noise to be averaged
    style = rr.SeriesLines(names=scene.learner, colors=colour, widths=3, aggregation_policy="off")
    for quantity in ERRORS:
        _plot(scene, f"errors/{quantity}/{scene.learner}", results[quantity], style)


def send_published(scene: Scene, published: Mapping[str, float]) -> None:
    """The published initial errors, if there are any, as straight lines in the plots."""
    for quantity, unit in zip(ERRORS, UNITS, strict=True):
        if quantity in published:
            name = f"the paper, before: {published[quantity]} {unit}"
            level = np.full(len(scene.motion.iterations), published[quantity])
            style = rr.SeriesLines(names=name, colors=GREY, widths=1)
            _plot(scene, f"errors/{quantity}/{PUBLISHED}", level, style)


def _plot(scene: Scene, entity: str, values: np.ndarray, style: rr.SeriesLines) -> None:
    clock, rows = scene.motion.measurements()
    scene.rec.send_columns(entity, clock, rr.Scalars.columns(scalars=values[rows]))
    scene.rec.log(entity, style, static=True)


def send_landings(scene: Scene) -> None:
    """Achieved frames and misses, as lines: the closer to the desired pose, the thinner."""
    watched, unit = scene.watched, unit_of(scene.workspace)
    _, rows = scene.motion.measurements()
    achieved, poses = watched.achieved[rows], len(watched.desired)
    desired = np.broadcast_to(watched.desired, achieved.shape)
    reached, meant = (
        axes_of(frames.reshape(-1, 4, 4), AXIS * unit) for frames in (achieved, desired)
    )
    misses = np.stack([meant[::3, 0], reached[::3, 0]], axis=1)  # from origin to origin
    tips = np.stack([meant[:, 1], reached[:, 1]], axis=1)
    for part, strips, apart, widest in (
        ("reached", reached, tips, 0.01 * unit),
        ("miss", misses, misses, 0.03 * unit),
    ):
        far = np.linalg.norm(apart[:, 1] - apart[:, 0], axis=-1)
        lines = rr.LineStrips3D.columns(strips=strips, radii=np.minimum(far / 4, widest))
        each = poses * len(strips) // len(misses)
        scene.show(part, lines, each, rr.LineStrips3D.from_fields(colors=REACHED))


def send_scatter(scene: Scene) -> None:
    """Lines from where the arm lands to what was measured there: noise, outliers, repeatability."""
    watched, (_, rows) = scene.watched, scene.motion.measurements()
    poses, repeated, _ = watched.scatter.shape
    landed = np.repeat(watched.achieved[rows, :, None, :3, 3], repeated, axis=2)
    ends = landed + enlarged(watched) * watched.scatter
    lines = rr.LineStrips3D.columns(strips=np.stack([landed, ends], axis=-2).reshape(-1, 2, 3))
    style = rr.LineStrips3D.from_fields(radii=0.009 * unit_of(scene.workspace), colors=MEASURED)
    scene.show("measured", lines, poses * repeated, style)


def enlarged(watched: Watched) -> int:
    """How many times as large the errors of measurements are drawn to be visible: 1, 10, ..."""
    spread, times = np.sqrt(np.square(watched.scatter).sum(axis=-1).mean()), 1
    while 0 < spread * times < VISIBLE:
        times *= 10
    return times


def send_map(scene: Scene, cells: MapCells) -> None:
    """The supernet's cells, larger the more they learned last.

    Their corrections are true to scale.
    """
    unit, (_, rows) = unit_of(scene.workspace), scene.motion.measurements()
    points = rr.Points3D.columns(radii=(0.022 + 0.038 * cells.weights[rows].ravel()) * unit)
    cell = rr.Points3D(cells.centres, colors=NOMINAL)
    scene.show("map/cells", points, len(cells.centres), cell)
    arrows = rr.Arrows3D.columns(vectors=cells.corrections[rows].reshape(-1, 3))
    arrow = rr.Arrows3D.from_fields(origins=cells.centres, radii=0.011 * unit, colors=NOMINAL)
    scene.show("map/corrections", arrows, len(cells.centres), arrow)
