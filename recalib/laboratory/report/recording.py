"""A recording for the Rerun viewer: the arm in each measured posture, and its error there."""

from pathlib import Path

import numpy as np
import rerun as rr
import rerun.blueprint as rrb

from recalib.laboratory.calibrate import Calibrated
from recalib.laboratory.viewer.arms import ARM, GREY, ROW, THICK, log_meshes, send_arm

COLOURS = {"before": (213, 94, 0), "after": (0, 114, 178)}
LONGEST = 0.12  # m: so long is the largest error shown


def write_recording(path: Path, result: Calibrated) -> None:
    """Write the recording of a calibration. Everything stands in the arm's base."""
    positions, residuals = result.positions, result.residuals
    longer = float(f"{LONGEST / np.linalg.norm(residuals['before'][:, :3], axis=1).max():.0e}")
    rr.set_strict_mode(True)  # a mere warning would leave a hole in the recording
    with rr.RecordingStream("recalib calibration") as rec:
        rec.save(path, default_blueprint=_blueprint(longer))
        rec.log("/", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
        rec.log("measured", rr.Points3D(positions, radii=THICK, colors=GREY), static=True)
        visuals, _ = log_meshes(rec, result.source, result.urdf, ARM)
        joints = result.observations.joints
        every = rr.TimeColumn(ROW, sequence=np.arange(1, len(joints) + 1))
        send_arm(rec, result.arm, visuals, [every], joints)
        rows = rr.TimeColumn(ROW, sequence=result.counted + 1)
        for name, its in residuals.items():
            arrows = rr.Arrows3D(
                origins=positions,
                vectors=longer * its[:, :3],
                colors=COLOURS[name],
                radii=THICK / 3,
            )
            rec.log(f"residuals/{name}", arrows, static=True)
            lines = rr.SeriesLines(colors=COLOURS[name], names=name)
            rec.log(f"errors/{name}", lines, static=True)
            errors = 1e3 * np.linalg.norm(its[:, :3], axis=1)
            rec.send_columns(f"errors/{name}", [rows], rr.Scalars.columns(scalars=errors))
        here = rr.Points3D.columns(positions=positions, radii=[4 * THICK] * len(positions))
        rec.send_columns("now", [rows], here)


def _blueprint(longer: float) -> rrb.Blueprint:
    return rrb.Blueprint(
        rrb.Vertical(
            rrb.Spatial3DView(
                origin="/",
                name=f"the arm, and its errors {longer:g} times as long",
                contents=["+ /**", "- /errors/**"],
            ),
            rrb.TimeSeriesView(
                origin="errors", name="position error on rows not learned from [mm]"
            ),
            row_shares=[3, 1],
        ),
        rrb.TimePanel(timeline=ROW, fps=4),
        collapse_panels=True,
    )
