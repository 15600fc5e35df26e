"""The commands of `recalib`: for each, a function of the same name that takes the options."""

import argparse
import os
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from recalib import laboratory, vision
from recalib.errors import InvalidFile, InvalidSetting
from recalib.files.outputs import check_new, write_new
from recalib.files.quantities import ANGLE, LENGTH
from recalib.identification.checks.diagnostics import FEWEST
from recalib.laboratory.calibrate import Calibrated, calibrate_arm
from recalib.laboratory.correction import BASE, INSTRUMENT, load_correction
from recalib.laboratory.hand_eye.pose_table import read_poses
from recalib.laboratory.live.allowed import Box
from recalib.laboratory.options import BOARD, BY_POSES, CONE, DONE, IN_HAND, NO_BETTER, OF_ARMS
from recalib.laboratory.propose import propose, useful
from recalib.laboratory.reaching import Goals
from recalib.laboratory.report.folder import files_of
from recalib.laboratory.report.warnings_of_commands import warnings_of
from recalib.laboratory.tables.columns import TARGETS
from recalib.laboratory.tables.conventions import convention_of
from recalib.laboratory.tables.description import within
from recalib.laboratory.tables.measurements import pose_rows, postures_table, read_desired
from recalib.laboratory.tables.table import read_table, table_text
from recalib.laboratory.urdf.dh_table import read_rows, urdf_of
from recalib.nominal.denavit_hartenberg import arm_of_table
from recalib.spelling import counted

ENOUGH = 0.05  # of the uncertainty: a smaller reduction is not worth the measurements
Options = argparse.Namespace


def calibrate(options: Options) -> int:
    """Write a folder of results from a table, from folders of pictures, or from flange poses."""
    if options.poses is None:
        _without(options, BY_POSES, "--poses", "a table of poses")
    else:
        options.board = options.board or BOARD
        if options.urdf is None:
            _without(options, OF_ARMS, "URDF", "an arm")
            return calibrate_poses(options)
        if options.measurements:
            raise InvalidSetting("measurements", str(options.measurements[0]), "none, with --poses")
        options.measurements = [_observed(options)]
    if not options.measurements:
        valid = "URDF and a table, or --poses and --pictures"
        raise InvalidSetting("measurements", None, valid)
    return calibrate_rows(options)


def _without(options: Options, names: Sequence[str], missing: str, valid: str) -> None:
    """Raise InvalidSetting if an option is given that has no effect where another is missing."""
    for name in names:
        if getattr(options, name):
            raise InvalidSetting(missing, None, f"{valid}, for --{name.replace('_', '-')}")


def calibrate_poses(options: Options) -> int:
    """Write a folder with the poses of camera and board, without a URDF."""
    if (options.pictures is None) == (options.targets is None):
        raise InvalidSetting("--pictures", options.pictures, "a folder, or --targets and a table")
    inverse, in_hand = options.inverse or (), options.camera == IN_HAND
    flange = read_poses(options.poses, options.convention, options.unit, "flange" in inverse)
    if options.targets is None:
        given = options.pictures, options.board, options.lens, in_hand, print_progress
        shown: Any = laboratory.pictures_at(flange, *given)
    else:
        unit = options.target_unit or options.unit
        settings = options.target_convention, unit, "targets" in inverse, True
        shown = read_poses(options.targets, *settings)
    height = options.height and within("--height", options.height, LENGTH, 1e-4)
    files, good = laboratory.calibrate_poses(flange, shown, in_hand, height, print_progress)
    return _written(options.out, files, good)


def calibrate_rows(options: Options) -> int:
    """Write a folder with the calibration of an arm, from a table or from folders of pictures."""
    page_of = laboratory.page_of  # imported first, to report a missing package at once
    recording_of = laboratory.recording_of if options.recording else None
    paths: list[Path] = options.measurements
    folders = [path for path in paths if os.path.isdir(path)]
    if len(paths) > 1 and len(folders) < len(paths):
        valid = "expected: one table, or folders from recalib observe"
        raise InvalidFile(paths[0], f"it is one of {len(paths)} tables; {valid}")
    settings = options.description, options.tool, options.base, print_progress
    if folders:
        result: Calibrated = laboratory.calibrate_pictures(options.urdf, folders, *settings)
    else:
        result = calibrate_arm(options.urdf, paths[0], *settings)
    print_progress(f"files in {options.out}")
    files, remark = files_of(result) | {"page.html": page_of(result)}, ""
    if recording_of:
        recording, remark = recording_of(result)
        files |= {"recording.rrd": recording} if recording else {}
    code = _written(options.out, files, result.worthwhile)
    print(remark, end="\n" * bool(remark))
    return code


def _written(out: Path, files: dict[str, bytes], good: bool) -> int:
    """Write a folder, print its summary and return the exit code."""
    write_new(out, files)
    print(files["summary.txt"].decode(), end="")
    print(f"\n{out}: {', '.join(files)}")
    return DONE if good else NO_BETTER


def _observed(options: Options) -> Path:
    """Observe pictures with the joints of a table; return the folder, next to the output."""
    if options.pictures is None:
        raise InvalidSetting("--pictures", None, "a folder of pictures; or --targets, and no URDF")
    folder, table = Path(f"{options.out}_observed"), read_table(options.poses)
    rotations = convention_of(options.convention).headings if options.convention else ()
    cells = {name: cells for name, cells in table.cells.items() if name.lower() not in rotations}
    given = {"joints": replace(table, cells=cells), "name": "camera", "out": folder}
    observe(Options(**vars(options) | given))
    return folder


def live(options: Options) -> int:
    """Move and measure, then calibrate from all rows."""
    observed = Path(options.out).with_name(f"{Path(options.out).name}_observed")
    if options.board is not None:
        check_new(observed, folder=True)
    ended = laboratory.measure_live(options, print_progress)
    print_progress(f"ended: {ended.reason}")
    if ended.rows < FEWEST:
        more = f"a calibration needs {FEWEST}; to continue, repeat the command"
        print(f"{counted(ended.rows, 'row')} in {options.table}; {more}")
        return DONE
    options.measurements = [options.table]
    if options.board is not None:  # all corners together determine the lens, too
        pictures = {"pictures": Path("."), "joints": options.table, "name": "camera", "lens": None}
        observe(Options(**vars(options) | pictures | {"out": observed}))
        options.measurements = [observed]
    return calibrate_rows(options)


def correct(options: Options) -> int:
    """Write commands that reach the desired poses."""
    correction, frame = load_correction(options.calibration), options.frame
    arm = correction.arm
    rows = read_desired(options.desired, arm, target=frame != BASE)
    poses, targets = rows.measured, rows.columns.get(TARGETS.name)
    if poses is None:  # joints alone stand for the pose that the nominal arm has there
        if frame == INSTRUMENT:
            valid = "a target's poses in the instrument's frame; joints alone need --frame base"
            raise InvalidFile(options.desired, f"x, y, z are missing; expected: {valid}")
        if not correction.base_known:
            reason = (
                "joints alone mean poses in the arm's base, which the measurements do not determine"
            )
            valid = "x, y, z in the instrument's frame"
            raise InvalidFile(options.desired, f"{reason}; expected: {valid}")
        assert rows.joints is not None
        poses, frame = arm.forward(arm.coupling.joints(rows.joints)), BASE
    names = None if targets is None else targets.tolist()
    commands = correction.correct(poses, rows.joints, names, frame)
    table = postures_table(arm, commands.joints, commands.poses, fake=True)
    write_new(options.out, table, ".csv")
    for line in warnings_of(correction, commands, frame):
        print(f"recalib: warning: {line}", file=sys.stderr)
    made = counted(len(commands.joints), "command")
    print(f"{made} in {options.out}: joint coordinates, and at them")
    print(f"the poses of {arm.tool} in {arm.base} by the nominal kinematics")
    return DONE


def next(options: Options) -> int:
    """Write the most informative postures or flange poses."""
    if options.poses:
        if options.candidates is not None:
            raise InvalidSetting("candidates", str(options.candidates), "none, with --poses")
        return next_poses(options)
    _without(options, ("box", "cone"), "--poses", "a calibration by them")
    correction = load_correction(options.calibration)
    candidates: np.ndarray | Goals | None = None
    if options.candidates is not None:
        rows = read_desired(options.candidates, correction.arm)
        candidates = rows.joints
        if rows.measured is not None:
            candidates = Goals.of(rows.measured, rows.joints, correction.arm.coupling)
    if candidates is not None:
        given, candidates = len(candidates), useful(correction, candidates)
        if left := given - len(candidates):
            why = "out of reach, or with a joint near the end of its range"
            left_out = f"{left} of {counted(given, 'candidate')} left out: {why}"
            print(f"recalib: warning: {left_out}", file=sys.stderr)
    joints, deviations = propose(correction, options.count, candidates)
    poses = correction.arm.forward(correction.arm.coupling.joints(joints))
    write_new(options.out, postures_table(correction.arm, joints, poses), ".csv")
    before, after = 1e3 * deviations[[0, -1]]
    enough = after >= (1 - ENOUGH) * before
    print(f"{counted(len(joints), 'posture')} in {options.out}, the most informative first.")
    print(
        f"They would reduce the uncertainty of predicted positions from {before:.3g} mm to"
        f" {after:.3g} mm" + (": more rows are not worthwhile." if enough else ".")
    )
    return DONE


def next_poses(options: Options) -> int:
    """Write the flange poses that are most informative about the camera's pose."""
    box = None if options.box is None else Box.read(options.box)
    cone = ANGLE.value_of("--cone", options.cone or CONE)
    poses, deviations = laboratory.propose_poses(options.calibration, options.count, box, cone)
    write_new(options.out, table_text(pose_rows(poses)), ".csv")
    before, after = 1e3 * deviations[[0, -1]]
    print(f"{counted(len(poses), 'flange pose')} in {options.out}, the most informative first.")
    print(
        f"They would reduce the camera's uncertainty from {before:.3g} mm to {after:.3g} mm,"
        " apart from errors that vary smoothly with the pose."
    )
    return DONE


def urdf(options: Options) -> int:
    """Write the URDF of a table of Denavit-Hartenberg parameters."""
    arm = arm_of_table(read_rows(options.links), options.convention)
    write_new(options.out, urdf_of(arm).encode(), ".urdf")
    print(f"{options.out}: {', '.join(arm.joints)}, from {arm.base} to {arm.tool}")
    return DONE


def board(options: Options) -> int:
    """Write a board to print, and its description."""
    sheet = vision.printable(options.columns, options.rows, options.square)
    (pdf, svg), paper, bar = vision.draw_board(sheet, "pdf", "svg")
    files = {"board.pdf": pdf, "board.svg": svg, "board.toml": sheet.described().encode()}
    write_new(options.out, files)
    print(f"{options.out}: {', '.join(files)}. Print at true size, on {paper[0]:g} x")
    print(f"{paper[1]:g} mm, glue it to something flat, and check that the bar is {bar:g} mm long.")
    return DONE


def observe(options: Options) -> int:
    """Write a folder with the corners found in pictures, and their page."""
    pictures = options.pictures, options.joints, options.board, options.lens
    check_new(options.out, folder=True)
    page_of_pictures = laboratory.page_of_pictures
    result = laboratory.observe(*pictures, options.camera == IN_HAND, print_progress, options.name)
    write_new(options.out, result.files() | {"page.html": page_of_pictures(result)})
    print(result.summary(), end="")
    print(f"\n{options.out}: see page.html; next: recalib calibrate ARM.urdf {options.out}")
    return DONE


def print_progress(line: str) -> None:
    print(f"... {line}", file=sys.stderr, flush=True)
