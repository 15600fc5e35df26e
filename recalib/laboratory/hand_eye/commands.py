"""What `recalib calibrate --poses` and `recalib next --poses` do with their options."""

import argparse

from recalib.errors import InvalidSetting
from recalib.files.outputs import write_new
from recalib.files.quantities import ANGLE, LENGTH
from recalib.laboratory.hand_eye import calibrating
from recalib.laboratory.hand_eye.pose_table import PoseTable, read_poses
from recalib.laboratory.hand_eye.proposing import propose_poses
from recalib.laboratory.live.allowed import Box
from recalib.laboratory.options import DONE, NO_BETTER
from recalib.laboratory.pictures.observed import Observed
from recalib.laboratory.tables.description import within
from recalib.laboratory.tables.measurements import pose_rows
from recalib.laboratory.tables.table import table_text
from recalib.spelling import counted

Options = argparse.Namespace


def calibrate_poses(options: Options, on_progress: calibrating.Progress) -> int:
    """Write a folder of where camera and board are, without a URDF."""
    if (options.pictures is None) == (options.targets is None):
        raise InvalidSetting("--pictures", options.pictures, "a folder, or --targets and a table")
    inverse, in_hand = options.inverse or (), options.camera == "hand"
    flange = read_poses(options.poses, options.convention, options.unit, "flange" in inverse)
    shown: Observed | PoseTable
    if options.targets is None:
        given = options.pictures, options.board, options.lens, in_hand, on_progress
        shown = calibrating.pictures_at(flange, *given)
    else:
        own = options.target_convention, options.unit, "targets" in inverse
        shown = read_poses(options.targets, *own)
    height = options.height and within("--height", options.height, LENGTH, 1e-4)
    result = calibrating.calibrate_poses(flange, shown, in_hand, height, on_progress)
    files = result.files()
    write_new(options.out, files)
    print(result.summary(), end="")
    print(f"\n{options.out}: {', '.join(files)}")
    return DONE if result.good else NO_BETTER


def next_poses(options: Options) -> int:
    """Write the poses of a flange with the most information on a camera's place."""
    box = None if options.box is None else Box.read(options.box)
    cone = ANGLE.value_of("--cone", options.cone)
    poses, deviations = propose_poses(options.calibration, options.count, box, cone)
    write_new(options.out, table_text(pose_rows(poses)), ".csv")
    before, after = 1e3 * deviations[[0, -1]]
    print(f"{counted(len(poses), 'pose')} of the flange in {options.out}, the best first.")
    print(f"They would reduce the camera's deviation from {before:.3g} mm to {after:.3g} mm.")
    return DONE
