"""The command line: `recalib calibrate` and others; docs/own_arm.md, pictures.md and live.md."""

import argparse
import io
import os
import sys
import tempfile
from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from recalib.errors import RecalibError, UnknownName
from recalib.laboratory.outputs import check_new, is_taken, new

CACHE = "MPLCONFIGDIR"  # the variable with the folder of Matplotlib's
CAMERAS = "fixed", "hand"
DONE, REFUSED, NO_BETTER = 0, 1, 3  # exit codes; argparse's own is 2
EPILOGUE = f"Exit codes: {DONE} done, {REFUSED} refused, {NO_BETTER} no better than doing nothing."


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command, and return its exit code. A mistake is one sentence on stderr."""
    words = sys.argv[1:] if arguments is None else arguments
    parser, commands = _parser()
    if words and not words[0].startswith("-") and words[0] not in commands:
        parser.error(str(UnknownName("command", words[0], commands)))
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


def _parser() -> tuple[argparse.ArgumentParser, Collection[str]]:
    """What reads the command line, and the names of the commands."""
    parser = argparse.ArgumentParser(
        prog="recalib", description="Recalibrate a robot arm from measurements.", epilog=EPILOGUE
    )
    commands = parser.add_subparsers(required=True, metavar="COMMAND")

    def add(
        name: str, command: Callable[[argparse.Namespace], int], text: str
    ) -> argparse.ArgumentParser:
        own = commands.add_parser(name, help=text, description=text, epilog=EPILOGUE)
        folder = command in (_board, _observe, _calibrate, _live)
        own.set_defaults(command=command, makes_folder=folder)
        return own

    def add_arm(own: argparse.ArgumentParser) -> None:
        own.add_argument(
            "--tool", type=_name, help="tool link; needed only if the arm has several ends"
        )
        own.add_argument(
            "--base", type=_name, help="link whose frame poses are given in (default: the root)"
        )
        own.add_argument("--description", type=_path, help="frames, columns and distances (TOML)")
        own.add_argument(
            "--out", default="calibration", help="new folder to write (default: %(default)s)"
        )

    urdf = "URDF file, or the name of an arm of example-robot-data"
    own = add("calibrate", _calibrate, "identify the arm's parameters from measurements")
    own.add_argument("urdf", type=_name, help=urdf)
    own.add_argument(
        "measurements",
        type=_path,
        nargs="+",
        help="table (CSV), or the folders that observe wrote, one for each camera",
    )
    add_arm(own)

    own = add(
        "live", _live, "move, measure and calibrate until the predicted error is small enough"
    )
    own.add_argument(
        "station", type=_name, help="FILE.py:NAME, MODULE:NAME, or a quoted command line"
    )
    own.add_argument("urdf", type=_name, help=urdf)
    own.add_argument("--error", help="predicted error to end at, such as '0.3 mm'")
    own.add_argument(
        "--most",
        type=int,
        default=60,
        help="rows to end at in any case (default: %(default)s)",
    )
    own.add_argument(
        "--span",
        default="45 deg",
        help="range of each joint about the first posture, either way (default: %(default)s)",
    )
    own.add_argument(
        "--box", help="ranges of the tool's x, y, z: '-40 cm to 40 cm, 30 cm to 80 cm, 0 m to 1 m'"
    )
    own.add_argument(
        "--speed",
        type=float,
        default=0.1,
        help="share of the possible speed (default: %(default)s)",
    )
    own.add_argument(
        "--patience", default="60 s", help="time limit of a move or measurement (%(default)s)"
    )
    own.add_argument("--board", type=_path, help="board in the station's pictures (TOML)")
    own.add_argument("--lens", type=_path, help="lens calibration (YAML), with --board")
    own.add_argument("--camera", choices=CAMERAS, help="where it is (default: fixed)")
    own.add_argument("--yes", action="store_true", help="move without asking")
    own.add_argument("--view", action="store_true", help="show it in a window of rerun")
    own.add_argument(
        "--table",
        type=_path,
        default="measurements.csv",
        help="new, or begun by live (default: %(default)s)",
    )
    add_arm(own)

    own = add("correct", _correct, "compute commands that reach the desired poses")
    own.add_argument("calibration", type=_path, help="folder that calibrate wrote")
    own.add_argument("desired", type=_path, help="desired poses or joint coordinates (CSV)")
    own.add_argument(
        "--frame",
        choices=("base", "instrument"),
        default="base",
        help="frame of the poses: the tool link in the base, or a target in the instrument's frame"
        " (default: %(default)s)",
    )
    own.add_argument(
        "--out", default="commands.csv", help="new file to write (default: %(default)s)"
    )

    own = add(
        "next",
        _next,
        "propose the most informative postures, and say whether more are worth measuring",
    )
    own.add_argument("calibration", type=_path, help="folder that calibrate wrote")
    own.add_argument(
        "candidates",
        type=_path,
        nargs="?",
        help="postures to choose from (CSV); drawn unless given",
    )
    own.add_argument(
        "--count", type=_positive, default=10, help="number of postures (default: %(default)s)"
    )
    own.add_argument("--out", default="next.csv", help="new file to write (default: %(default)s)")

    own = add("urdf", _urdf, "write a URDF from Denavit-Hartenberg parameters")
    own.add_argument("links", type=_path, help="table (CSV): joint, a, alpha, d, theta, kind")
    own.add_argument(
        "--convention", default="standard", help="standard or modified (default: %(default)s)"
    )
    own.add_argument("--out", default="arm.urdf", help="new file to write (default: %(default)s)")

    own = add("board", _board, "draw a calibration board to print")
    own.add_argument("--kind", default="charuco", help="charuco or apriltag (default: %(default)s)")
    own.add_argument(
        "--columns", type=int, default=7, help="squares in a row (default: %(default)s)"
    )
    own.add_argument("--rows", type=int, default=5, help="rows of squares (default: %(default)s)")
    own.add_argument("--square", default="36 mm", help="width of a square (default: %(default)s)")
    own.add_argument("--out", default="board", help="new folder to write (default: %(default)s)")

    own = add("observe", _observe, "find the board in pictures, and calibrate the lens")
    own.add_argument("pictures", type=_path, help="folder of pictures")
    own.add_argument(
        "joints", type=_path, help="table (CSV) of joint coordinates, with a column picture"
    )
    own.add_argument("--board", type=_path, default="board/board.toml", help="its description")
    own.add_argument(
        "--lens", type=_path, help="lens calibration (YAML); from the pictures unless given"
    )
    own.add_argument("--camera", choices=CAMERAS, default="fixed", help="where it is")
    own.add_argument("--name", default="camera", help="its name, if there are several cameras")
    own.add_argument("--out", default="observed", help="new folder to write (default: %(default)s)")
    return parser, commands.choices


def _name(text: str) -> str:
    if not text:
        raise argparse.ArgumentTypeError("'' is no name")
    return text


def _path(text: str) -> Path:
    return Path(_name(text))


def _positive(text: str) -> int:
    if not text.isdecimal() or not int(text):
        raise argparse.ArgumentTypeError(f"{text!r} is no number from 1 on")
    return int(text)


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


def _calibrate(given: argparse.Namespace) -> int:
    return _calibrate_from(given, given.measurements)


def _live(given: argparse.Namespace) -> int:
    from recalib.laboratory.live_command import measure_live

    _print_progress(f"enough: {measure_live(given, _print_progress)}")
    return _calibrate_from(given, [given.table])


def _calibrate_from(given: argparse.Namespace, tables: Sequence[Path]) -> int:
    """Identify the arm from tables, and write and print what follows."""
    from recalib.laboratory.calibrate import calibrate_arm
    from recalib.laboratory.files import optional_outputs, write_files
    from recalib.laboratory.summary import summary

    result = calibrate_arm(
        given.urdf, tables, given.description, given.tool, given.base, _print_progress
    )
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

    from recalib.laboratory.correct import correct, unidentifiable_ends
    from recalib.laboratory.correction import load_correction
    from recalib.laboratory.files import CORRECTION, write_postures
    from recalib.laboratory.measurements import read_desired

    correction = load_correction(given.calibration / CORRECTION)
    in_instrument = given.frame == "instrument"
    desired = read_desired(given.desired, correction.arm, in_instrument)
    commands = correct(correction, desired, in_instrument)
    write_postures(given.out, correction.arm, commands.joints, commands.poses)
    ends = unidentifiable_ends(correction)
    if ends and not in_instrument:
        _warn(
            f"errors of {ends} are not identifiable from the measurements, so commands in the base"
            " have them. In the instrument's frame commands are right. Try: --frame instrument, or"
            " a description with [instrument] and [target]"
        )
    rows = np.flatnonzero(commands.beyond.any(axis=1))
    if len(rows):
        names = np.array(correction.arm.joints)[commands.beyond.any(axis=0)]
        _warn(
            f"{len(rows)} of {len(commands.joints)} commands, first in row {rows[0] + 1}, leave the"
            f" measured range: {', '.join(names)}"
        )
    print(f"{len(commands.joints)} commands in {given.out}: joint coordinates, and the poses that")
    print(f"the nominal kinematics give them, of {correction.arm.tool} in {correction.arm.base}")
    return DONE


def _next(given: argparse.Namespace) -> int:
    from recalib.laboratory.correction import load_correction
    from recalib.laboratory.files import CORRECTION, write_postures
    from recalib.laboratory.measurements import read_desired
    from recalib.laboratory.propose import propose

    correction = load_correction(given.calibration / CORRECTION)
    candidates = given.candidates and read_desired(given.candidates, correction.arm)
    proposal = propose(correction, given.count, candidates)
    write_postures(
        given.out, correction.arm, proposal.joints, correction.arm.forward(proposal.joints)
    )
    before, after = 1e3 * proposal.uncertainty[[0, -1]]
    print(f"{len(proposal.joints)} postures in {given.out}, the most informative first.")
    print(
        f"They would make the uncertainty of predicted positions fall from {before:.3g} mm to"
        f" {after:.3g} mm" + ("." if proposal.worthwhile else ": enough has been measured.")
    )
    return DONE


def _urdf(given: argparse.Namespace) -> int:
    from recalib.laboratory.links import read_rows, urdf_of
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
    from recalib.laboratory.observe import IN_HAND, observe, write_observed
    from recalib.laboratory.observed_page import write_observed_page

    files = given.pictures, given.joints, given.board, given.lens
    result = observe(*files, given.camera == IN_HAND, _print_progress, given.name)
    write_observed(result, given.out, write_observed_page)
    print(result.summary(), end="")
    print(f"\n{given.out}: see page.html; next: recalib calibrate ARM.urdf {given.out}")
    return DONE


def _warn(text: str) -> None:
    print(f"recalib: warning: {text}", file=sys.stderr)


def _print_progress(line: str) -> None:
    print(f"... {line}", file=sys.stderr, flush=True)
