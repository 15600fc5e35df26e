"""A recording for the Rerun viewer: the arm in each measured posture, with its errors."""

import numpy as np
import rerun as rr
import rerun.blueprint as rrb

from recalib.errors import InvalidSetting
from recalib.laboratory.logged_arm import ARM, GREY, ROW, THICK, log_meshes, send_arm
from recalib.laboratory.results import Results
from recalib.spelling import counted

COLOURS = {"before": (213, 94, 0), "after": (0, 114, 178)}
LONGEST = 0.12  # m: the drawn length of the largest error


def recording_of(result: Results) -> tuple[bytes, str]:
    """The recording of a calibration, in the arm's base, and a remark about missing parts.

    If Rerun cannot read the URDF, which happens with some that Pinocchio reads, the recording is
    empty. Raises InvalidSetting without a URDF.
    """
    if result.urdf is None:
        raise InvalidSetting("urdf", None, "the file of the arm; try: calibrate_arm")
    positions, residuals = result.positions, result.residuals
    longer = float(f"{LONGEST / np.linalg.norm(residuals['before'][:, :3], axis=1).max():.0e}")
    rr.set_strict_mode(True)  # else errors are only warnings, and the recording is incomplete
    with rr.RecordingStream("recalib calibration") as rec:
        memory = rec.memory_recording()
        rec.send_blueprint(_blueprint(longer))
        rec.log("/", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
        rec.log("measured", rr.Points3D(positions, radii=THICK, colors=GREY), static=True)
        try:
            visuals, missing = log_meshes(rec, result.urdf.content, result.urdf.path, ARM)
        except (RuntimeError, ValueError) as error:
            return b"", f"no recording: Rerun cannot draw {result.urdf.path}: {error}"
        joints = result.data.observations.joints
        every = rr.TimeColumn(ROW, sequence=np.arange(1, len(joints) + 1))
        send_arm(rec, result.arm, visuals, [every], joints)
        rows = rr.TimeColumn(ROW, sequence=result.counted + 1)
        for name, vectors in residuals.items():
            arrows = rr.Arrows3D(
                origins=positions,
                vectors=longer * vectors[:, :3],
                colors=COLOURS[name],
                radii=THICK / 3,
            )
            rec.log(f"residuals/{name}", arrows, static=True)
            lines = rr.SeriesLines(colors=COLOURS[name], names=name)
            rec.log(f"errors/{name}", lines, static=True)
            errors = 1e3 * np.linalg.norm(vectors[:, :3], axis=1)
            rec.send_columns(f"errors/{name}", [rows], rr.Scalars.columns(scalars=errors))
        here = rr.Points3D.columns(positions=positions, radii=[4 * THICK] * len(positions))
        rec.send_columns("now", [rows], here)
        meshes = counted(len(missing), "mesh file")
        words = f"the recording lacks {meshes} outside the URDF's packages, such as"
        return memory.drain_as_bytes(), f"{words} {missing[0]}" if missing else ""


def _blueprint(longer: float) -> rrb.Blueprint:
    return rrb.Blueprint(
        rrb.Vertical(
            rrb.Spatial3DView(
                origin="/",
                name=f"the arm, and its errors {longer:g} times as long",
                contents=["+ /**", "- /errors/**"],
            ),
            rrb.TimeSeriesView(origin="errors", name="held-out position error [mm]"),
            row_shares=[3, 1],
        ),
        rrb.TimePanel(timeline=ROW, fps=4),
        collapse_panels=True,
    )
