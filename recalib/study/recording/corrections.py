"""The cells of a map, as they learn."""

import numpy as np
import rerun as rr

from recalib.study.recording.cells import Cells
from recalib.study.recording.clocks import measurements
from recalib.study.recording.colours import BELIEVED, DIM, LIT
from recalib.study.recording.story import Motion, Watched


def send_map(
    rec: rr.RecordingStream,
    learner: str,
    unit: float,
    cells: Cells,
    watched: Watched,
    motion: Motion,
) -> None:
    """The supernet's cells, brighter and larger the more they learned last.

    Their corrections are true to scale.
    """
    clock, rows = measurements(watched, motion)
    each = [len(cells.centres)] * len(rows)
    weights = cells.weights[rows].ravel()
    light = (DIM + weights[:, None] * (LIT - DIM)).astype(np.uint8)
    points = rr.Points3D.columns(radii=(0.022 + 0.038 * weights) * unit, colors=light)
    arrows = rr.Arrows3D.columns(vectors=cells.corrections[rows].reshape(-1, 3))
    rec.send_columns(f"{learner}/map/cells", clock, points.partition(each))
    rec.send_columns(f"{learner}/map/corrections", clock, arrows.partition(each))
    rec.log(f"{learner}/map/cells", rr.Points3D(cells.centres), static=True)
    still = rr.Arrows3D.from_fields(origins=cells.centres, radii=0.011 * unit, colors=BELIEVED)
    rec.log(f"{learner}/map/corrections", still, static=True)
