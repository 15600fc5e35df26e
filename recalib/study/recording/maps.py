"""The cells of a map, as they learn."""

import numpy as np
import rerun as rr

from recalib.study.recording.colours import BELIEVED, DIM, LIT
from recalib.study.recording.scene import Scene, unit_of
from recalib.study.recording.watched import Cells


def send_map(scene: Scene, cells: Cells) -> None:
    """The supernet's cells, brighter and larger the more they learned last.

    Their corrections are true to scale.
    """
    unit, each = unit_of(scene.workspace), len(cells.centres)
    clock, rows = scene.motion.throughout()
    weights = cells.weights[rows].ravel()
    light = (DIM + weights[:, None] * (LIT - DIM)).astype(np.uint8)
    points = rr.Points3D.columns(radii=(0.022 + 0.038 * weights) * unit, colors=light)
    arrows = rr.Arrows3D.columns(vectors=cells.corrections[rows].reshape(-1, 3))
    scene.send("map/cells", clock, points, each)
    scene.send("map/corrections", clock, arrows, each)
    scene.log("map/cells", rr.Points3D(cells.centres))
    style = rr.Arrows3D.from_fields(origins=cells.centres, radii=0.011 * unit, colors=BELIEVED)
    scene.log("map/corrections", style)
