"""The command line: `recalib calibrate` and others; docs/own_arm.md, pictures.md and live.md."""

import argparse
import io
import os
import sys
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from recalib.errors import RecalibError, UnknownName
from recalib.files.outputs import check_new, is_taken, new
from recalib.laboratory.options import DONE, NO_BETTER, REFUSED, parser_of
from recalib.spelling import counted

TURNED = 0.01  # deg: a rotation that is off by less is reached
CACHE = "MPLCONFIGDIR"  # the variable with the folder of Matplotlib's


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command, and return its exit code. A mistake is one sentence on stderr."""
    words = sys.argv[1:] if arguments is None else arguments
    parser = parser_of(COMMANDS)
    if words and not words[0].startswith("-") and words[0] not in COMMANDS:
        parser.error(str(UnknownName("command", words[0], COMMANDS)))
    given = parser.parse_args(words)
    # NumPy reads it when it is imported. Of matrices so small, each thread would wait for others:
    # where something else is at work, ten times as long as it takes one alone.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    if isinstance(sys.stdout, io.TextIOWrapper):  # and nothing in its place
        sys.stdout.reconfigure(errors="backslashreplace")  # names may have letters that it lacks
    try:
        check_new(given.out, given.makes_folder)
        with _no_cache_at_home():
            return given.command(given)
    except RecalibError as error:
        message = str(error)
    except OSError as error:
        message = f"{error.filename}: {error.strerror}" if error.filename else str(error)
    except ModuleNotFoundError as error:
        package = (error.name or "").partition(".")[0]
        message = f"{package} is missing; try: pip install 'recalib[laboratory,vision]'"
    except MemoryError:
        message = "there is not enough memory for this; try: fewer rows"
    except KeyboardInterrupt:
        there = is_taken(given.out, given.makes_folder)
        message = f"interrupted; {given.out} is {'there, and whole' if there else 'not written'}"
    print(f"recalib: {message}", file=sys.stderr)
    return REFUSED


@contextmanager
def _no_cache_at_home() -> Iterator[None]:
    """Have Matplotlib keep its list of fonts in a folder that is removed, unless one is set.

    A command writes only what it says. Making the list anew takes it a fraction of a second.
    """
    if CACHE in os.environ:
        yield
        return
    with tempfile.TemporaryDirectory(prefix="recalib-") as folder:
        os.environ[CACHE] = folder
        try:
            yield
        finally:
            del os.environ[CACHE]


# Imported where they are used: help and refusals need not wait for Pinocchio and SciPy.


def _live(given: argparse.Namespace) -> int:
    from recalib.identification.checks.diagnostics import FEWEST
    from recalib.laboratory.live.command import measure_live

    observed = Path(given.out).with_name(f"{Path(given.out).name}_observed")
    if given.board is not None:
        check_new(observed, folder=True)
    ended = measure_live(given, _print_progress)
    _print_progress(f"ended: {ended.reason}")
    if ended.rows < FEWEST:
        rows = counted(ended.rows, "row")
        print(f"{rows} in {given.table}; a calibration needs {FEWEST}: the same call goes on")
        return DONE
    given.measurements = [given.table]
    if given.board is not None:  # all corners together tell more, also of the lens
        _write_observed(observed, ".", given.table, given.board, None, given.camera)
        given.measurements = [observed]
    return _calibrate(given)


def _calibrate(given: argparse.Namespace) -> int:
    from recalib.laboratory.calibrate import calibrate_arm
    from recalib.laboratory.report.files import optional_outputs, write_files
    from recalib.laboratory.report.summary import summary

    known = given.description, given.tool, given.base
    result = calibrate_arm(given.urdf, given.measurements, *known, _print_progress)
    further, missing = optional_outputs()
    _print_progress(f"files in {given.out}")
    written = write_files(result, given.out, further)
    print(summary(result), end="")
    print(f"\n{given.out}: {', '.join(written)}")
    for sentence in missing:
        print(sentence)
    return DONE if result.worthwhile else NO_BETTER


def _correct(given: argparse.Namespace) -> int:
    import numpy as np

    from recalib.laboratory.correction.correct import (
        beyond_measured,
        correct,
        outside_measured,
        unidentifiable_ends,
    )
    from recalib.laboratory.report.files import read_correction, write_postures
    from recalib.laboratory.tables.measurements import read_desired

    correction = read_correction(given.calibration)
    in_instrument = given.frame == "instrument"
    desired = read_desired(given.desired, correction.arm, in_instrument)
    commands = correct(correction, desired, in_instrument)
    write_postures(given.out, correction.arm, commands.joints, commands.poses, fake=True)
    ends = unidentifiable_ends(correction)
    if ends and not in_instrument:
        _warn(
            f"errors of {ends} are not identifiable from the measurements, so commands in the base"
            " have them. In the instrument's frame commands are right. Try: --frame instrument, a"
            " description with [instrument] and [target], or measured rotations"
        )
    turned = np.degrees(commands.turned)
    if turned.max() > TURNED:
        _warn(
            f"an arm of {len(correction.arm.joints)} joints reaches positions; rotations stay up to"
            f" {turned.max():.2g} deg from those desired, the most in row {turned.argmax() + 1}"
        )
    for warning in (beyond_measured(correction, commands), outside_measured(commands)):
        if warning:
            _warn(warning)
    made = counted(len(commands.joints), "command")
    print(f"{made} in {given.out}: joint coordinates, and the poses that")
    print(f"the nominal kinematics give them, of {correction.arm.tool} in {correction.arm.base}")
    return DONE


def _next(given: argparse.Namespace) -> int:
    from recalib.laboratory.propose import propose
    from recalib.laboratory.report.files import read_correction, write_postures
    from recalib.laboratory.tables.measurements import read_desired

    correction = read_correction(given.calibration)
    candidates = given.candidates and read_desired(given.candidates, correction.arm)
    proposal = propose(correction, given.count, candidates)
    write_postures(
        given.out, correction.arm, proposal.joints, correction.arm.forward(proposal.joints)
    )
    before, after = 1e3 * proposal.uncertainty[[0, -1]]
    print(f"{counted(len(proposal.joints), 'posture')} in {given.out}, the most informative first.")
    print(
        f"They would make the uncertainty of predicted positions fall from {before:.3g} mm to"
        f" {after:.3g} mm" + ("." if proposal.worthwhile else ": enough has been measured.")
    )
    return DONE


def _urdf(given: argparse.Namespace) -> int:
    from recalib.laboratory.arms.links import read_rows, urdf_of
    from recalib.nominal.denavit_hartenberg import arm_of_table

    arm = arm_of_table(read_rows(given.links), given.convention)
    with new(given.out) as made:
        made.write_text(urdf_of(arm), encoding="utf-8")
    print(f"{given.out}: {', '.join(arm.joints)}, from {arm.base} to {arm.tool}")
    return DONE


def _board(given: argparse.Namespace) -> int:
    from recalib.files.quantities import LENGTH
    from recalib.vision.boards import printable
    from recalib.vision.printing import BAR, draw_board

    board = printable(
        given.kind, given.columns, given.rows, LENGTH.value_of("--square", given.square)
    )
    with new(given.out, folder=True) as made:
        wide, high = draw_board(board, made / "board.pdf", made / "board.svg")
        (made / "board.toml").write_text(board.described(), encoding="utf-8")
    print(f"{given.out}: board.pdf, board.svg, board.toml. Print at true size, on {wide:g} x")
    print(f"{high:g} mm, glue it to something flat, and measure the bar: it is {BAR:g} mm long.")
    return DONE


def _observe(given: argparse.Namespace) -> int:
    files = given.pictures, given.joints, given.board, given.lens
    _write_observed(given.out, *files, given.camera, given.name)
    print(f"\n{given.out}: see page.html; next: recalib calibrate ARM.urdf {given.out}")
    return DONE


def _write_observed(
    out: str | Path,
    pictures: str | Path,
    joints: Path,
    board: Path,
    lens: Path | None,
    camera: str | None,
    name: str = "camera",
) -> None:
    from recalib.laboratory.pictures.observe import observe
    from recalib.laboratory.pictures.observed import IN_HAND, write_observed
    from recalib.laboratory.report.observed_page import write_observed_page

    in_hand = camera == IN_HAND
    result = observe(pictures, joints, board, lens, in_hand, _print_progress, name)
    write_observed(result, out, write_observed_page)
    print(result.summary(), end="")


def _warn(text: str) -> None:
    print(f"recalib: warning: {text}", file=sys.stderr)


def _print_progress(line: str) -> None:
    print(f"... {line}", file=sys.stderr, flush=True)


COMMANDS = {
    "calibrate": _calibrate,
    "live": _live,
    "correct": _correct,
    "next": _next,
    "urdf": _urdf,
    "board": _board,
    "observe": _observe,
}
