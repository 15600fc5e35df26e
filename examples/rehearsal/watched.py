"""Watch a live calibration in the Rerun viewer: the arm, the measurements, the predicted error.

python examples/rehearsal/watched.py examples/station.py:BentUR10 ur10_robot.urdf tool0

With a camera: watched_pictures.py.

Each point of the workspace is the tool in an allowed posture. It is orange where the predicted
error is as large as it ever was, and blue where it is gone.
"""

import sys
from functools import partial
from pathlib import Path

import numpy as np
import rerun as rr
import rerun.blueprint as rrb

from recalib import Arm, LiveSettings, Observations, calibrate_live, load_arm
from recalib.laboratory.live.running import RunningCalibration
from recalib.laboratory.logged_arm import ARM, GREY, ROW, THICK, log_meshes, send_arm
from recalib.nominal.descriptions import find_urdf
from recalib.nominal.shapes import load_shapes
from recalib.station.opening import open_station

SURE, UNSURE = np.array([0, 114, 178]), np.array([213, 94, 0])
PANELS = rrb.Blueprint(
    rrb.Vertical(
        rrb.Spatial3DView(
            origin="/", name="the arm", contents=["+ /**", "- /error/**", "- /picture/**"]
        ),
        rrb.TimeSeriesView(origin="error", name="predicted error [mm]"),
        row_shares=[3, 1],
    ),
    collapse_panels=True,
)


class LiveView:
    """Shows the calibration after each row."""

    def __init__(self, arm: Arm, urdf: Path, rec: rr.RecordingStream) -> None:
        self._arm, self._worst, self._rec = arm, 0.0, rec
        rec.send_blueprint(PANELS)
        rec.log("/", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
        self._visuals, _ = log_meshes(rec, urdf.read_bytes(), urdf, ARM)

    def show(self, rows: Observations, running: RunningCalibration) -> None:
        rec, clock = self._rec, [rr.TimeColumn(ROW, sequence=[len(rows)])]
        rec.set_time(ROW, sequence=len(rows))
        send_arm(rec, self._arm, self._visuals, clock, rows.joints[-1:])
        if not running.is_ready(rows):
            return
        base = np.linalg.inv(running.calibration(rows).frames.base)
        measured = rows.positions @ base[:3, :3].T + base[:3, 3]
        rec.log("measured", rr.Points3D(measured, radii=THICK, colors=GREY))
        postures, deviations = running.workspace(rows)
        self._worst = max(self._worst, deviations.max())
        part = (deviations / self._worst)[:, None]
        colours = ((1 - part) * SURE + part * UNSURE).astype(np.uint8)
        places = self._arm.forward(postures)[:, :3, 3]
        rec.log("workspace", rr.Points3D(places, radii=2 * THICK, colors=colours))
        if np.isfinite(error := running.error(rows)):
            rec.log("error/predicted", rr.Scalars(1e3 * error))


if __name__ == "__main__":
    station, urdf, tool = sys.argv[1:]
    arm = load_arm(urdf, tool)
    with rr.RecordingStream("recalib live") as rec:
        rec.spawn()  # or rec.save("live.rrd")
        view = LiveView(arm, find_urdf(urdf), rec)
        shapes, _ = load_shapes(arm, urdf)
        opening = partial(open_station, station)
        table = "measurements.csv"
        calibrate_live(opening, arm, table, LiveSettings(), on_row=view.show, shapes=shapes)
