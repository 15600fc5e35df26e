"""What was measured while the arm learned: errors, landings, cells of a map."""

import numpy as np
import rerun as rr

from replication.recording.colours import NOMINAL, REACHED
from replication.recording.scene import Scene
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
    """Misses, as lines from the desired to the achieved positions."""
    _, rows = scene.motion.measurements()
    achieved = scene.watched.achieved[rows][..., :3, 3]
    desired = np.broadcast_to(scene.watched.desired[:, :3, 3], achieved.shape)
    misses = np.stack([desired, achieved], axis=2).reshape(-1, 2, 3)
    style = rr.LineStrips3D.from_fields(colors=REACHED, radii=0.02 * scene.unit)
    lines = rr.LineStrips3D.columns(strips=misses)
    scene.show("map/miss", lines, len(scene.watched.desired), style)


def send_map(scene: Scene) -> None:
    """The supernet's cells, larger the more they learned last.

    Their corrections are true to scale.
    """
    cells, unit = scene.watched.cells, scene.unit
    _, rows = scene.motion.measurements()
    points = rr.Points3D.columns(radii=(0.022 + 0.038 * cells.weights[rows].ravel()) * unit)
    cell = rr.Points3D(cells.centres, colors=NOMINAL)
    scene.show("map/cells", points, len(cells.centres), cell)
    arrows = rr.Arrows3D.columns(vectors=cells.corrections[rows].reshape(-1, 3))
    arrow = rr.Arrows3D.from_fields(origins=cells.centres, radii=0.011 * unit, colors=NOMINAL)
    scene.show("map/corrections", arrows, len(cells.centres), arrow)
