"""A live calibration in the Rerun viewer: the arm, what is estimated of it, the predicted error."""

from pathlib import Path

import numpy as np
import rerun as rr
import rerun.blueprint as rrb
from rerun.experimental import ViewerClient

from recalib.errors import InvalidSetting
from recalib.identification.model.observations import Observations
from recalib.laboratory.live.running import RunningCalibration
from recalib.laboratory.viewer.arms import ARM, GREY, ROW, THICK, log_meshes, send_arm
from recalib.laboratory.viewer.program import HERE, answer, free_port, start
from recalib.nominal.kinematics import Arm

SURE, UNSURE = np.array([0, 114, 178]), np.array([213, 94, 0])


class LiveView:
    """What is shown: the nominal arm, the targets as measured, and the workspace.

    Each point of the workspace is the tool in an allowed posture. It is orange where the predicted
    error is as large as it ever was, and blue where it is gone.

    Args:
        rec: where it goes; a window unless given.
        source: of the URDF at the path `urdf`.

    Raises InvalidSetting: no window opens.
    """

    def __init__(self, arm: Arm, source: bytes, urdf: Path, rec: rr.RecordingStream | None = None):
        self._arm, self._worst = arm, 0.0
        self._rec = rec = rec or _window()
        rec.send_blueprint(_BLUEPRINT)
        rec.log("/", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
        self._visuals, _ = log_meshes(rec, source, urdf, ARM)

    def show(self, rows: Observations, running: RunningCalibration) -> None:
        """Show what is known after some rows."""
        rec, clock = self._rec, [rr.TimeColumn(ROW, sequence=[len(rows)])]
        rec.set_time(ROW, sequence=len(rows))
        send_arm(rec, self._arm, self._visuals, clock, rows.joints[-1:])
        if not running.is_ready(rows):
            return
        calibration, error = running.calibration(rows), running.error(rows)
        base = np.linalg.inv(calibration.frames.base)
        measured = rows.positions @ base[:3, :3].T + base[:3, 3]
        rec.log("measured", rr.Points3D(measured, radii=THICK, colors=GREY))
        probes, deviations = running.workspace(rows)
        self._worst = max(self._worst, deviations.max())
        part = (deviations / self._worst)[:, None]
        colours = ((1 - part) * SURE + part * UNSURE).astype(np.uint8)
        places = self._arm.forward(probes)[:, :3, 3]
        rec.log("workspace", rr.Points3D(places, radii=2 * THICK, colors=colours))
        rec.log("error/by_the_model", rr.Scalars(1e3 * error.by_model))
        if np.isfinite(error.by_rows):
            rec.log("error/by_the_last_rows", rr.Scalars(1e3 * error.by_rows))


def _window() -> rr.RecordingStream:
    """What goes to a window of its own, which stays open when this process ends."""
    port = free_port()
    process, url = start("--port", port, outlives=True), f"rerun+http://{HERE}:{port}/proxy"
    try:
        # it listens before it finds that there is no display; only a window tells its state
        answer(process, lambda: ViewerClient(url).get_state())
    except BaseException as error:
        process.terminate()
        process.wait()
        if not isinstance(error, ConnectionError):
            raise
        raise InvalidSetting("--view", "without a window", "a display, for rerun") from None
    rec = rr.RecordingStream("recalib live")
    rec.connect_grpc(url)
    return rec


_BLUEPRINT = rrb.Blueprint(
    rrb.Vertical(
        rrb.Spatial3DView(
            origin="/",
            name="the arm, its targets, and the predicted error",
            contents=["+ /**", "- /error/**"],
        ),
        rrb.TimeSeriesView(origin="error", name="predicted error [mm]"),
        row_shares=[3, 1],
    ),
    collapse_panels=True,
)
