"""What was measured while the arm learned: errors, landings, cells of a map."""

import numpy as np
import rerun as rr

from replication.recording.colours import NOMINAL, REACHED
from replication.recording.scene import AXIS, Scene, axes_of, unit_of
from replication.training.measured import ERRORS


def send_errors(scene: Scene) -> None:
    """Mean errors over all test poses."""
    results, (clock, rows) = scene.watched.history.columns(), scene.motion.measurements()
    # a few moves in a moment are no noise to be averaged
    style = rr.SeriesLines(names=scene.learner, colors=NOMINAL, widths=3, aggregation_policy="off")
    for quantity in ERRORS:
        entity = f"errors/{quantity}/{scene.learner}"
        scene.rec.send_columns(entity, clock, rr.Scalars.columns(scalars=results[quantity][rows]))
        scene.rec.log(entity, style, static=True)


def send_landings(scene: Scene) -> None:
    """Achieved frames and misses, as lines: the closer to the desired pose, the thinner."""
    watched, unit = scene.watched, unit_of(scene.workspace)
    _, rows = scene.motion.measurements()
    achieved, poses = watched.achieved[rows], len(watched.desired)
    desired = np.broadcast_to(watched.desired, achieved.shape)
    reached, goals = (
        axes_of(frames.reshape(-1, 4, 4), AXIS * unit) for frames in (achieved, desired)
    )
    misses = np.stack([goals[::3, 0], reached[::3, 0]], axis=1)  # from origin to origin
    tips = np.stack([goals[:, 1], reached[:, 1]], axis=1)
    for part, strips, apart, widest in (
        ("reached", reached, tips, 0.01 * unit),
        ("miss", misses, misses, 0.03 * unit),
    ):
        far = np.linalg.norm(apart[:, 1] - apart[:, 0], axis=-1)
        lines = rr.LineStrips3D.columns(strips=strips, radii=np.minimum(far / 4, widest))
        count = poses * len(strips) // len(misses)
        scene.show(part, lines, count, rr.LineStrips3D.from_fields(colors=REACHED))


def send_map(scene: Scene) -> None:
    """The supernet's cells, larger the more they learned last.

    Their corrections are true to scale.
    """
    cells, unit = scene.watched.cells, unit_of(scene.workspace)
    _, rows = scene.motion.measurements()
    points = rr.Points3D.columns(radii=(0.022 + 0.038 * cells.weights[rows].ravel()) * unit)
    cell = rr.Points3D(cells.centres, colors=NOMINAL)
    scene.show("map/cells", points, len(cells.centres), cell)
    arrows = rr.Arrows3D.columns(vectors=cells.corrections[rows].reshape(-1, 3))
    arrow = rr.Arrows3D.from_fields(origins=cells.centres, radii=0.011 * unit, colors=NOMINAL)
    scene.show("map/corrections", arrows, len(cells.centres), arrow)
