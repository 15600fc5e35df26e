"""How measurements scatter about where an arm lands: noise, outliers, poor repeatability."""

import numpy as np
import rerun as rr

from recalib.study.recording.clocks import measurements
from recalib.study.recording.colours import MEASURED
from recalib.study.recording.story import Motion, Watched

SEEN = 0.01  # m: measurements that scatter less are drawn enlarged


def send_scatter(
    rec: rr.RecordingStream, learner: str, unit: float, watched: Watched, motion: Motion
) -> None:
    """Lines from where the arm lands to what was measured there."""
    clock, rows = measurements(watched, motion)
    landed = np.repeat(watched.achieved[rows, :, None, :3, 3], watched.scatter.shape[1], axis=2)
    ends = landed + enlarged(watched) * watched.scatter
    lines = np.stack([landed, ends], axis=-2).reshape(-1, 2, 3)
    columns = rr.LineStrips3D.columns(strips=lines)
    rec.send_columns(
        f"{learner}/measured", clock, columns.partition([len(lines) // len(rows)] * len(rows))
    )
    look = rr.LineStrips3D.from_fields(radii=0.009 * unit, colors=MEASURED)
    rec.log(f"{learner}/measured", look, static=True)


def enlarged(watched: Watched) -> int:
    """How many times as large the errors of measurements are drawn to be seen: 1, 10, ..."""
    spread, times = np.sqrt(np.square(watched.scatter).sum(axis=-1).mean()), 1
    while 0 < spread * times < SEEN:
        times *= 10
    return times
