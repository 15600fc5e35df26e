"""The options of each command of `recalib`."""

import argparse
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NoReturn

from recalib import __version__
from recalib.errors import InvalidQuantity, UnknownName
from recalib.files.quantities import LENGTH
from recalib.laboratory.tables.columns import MEASURED

FIXED, IN_HAND = CAMERAS = "fixed", "hand"  # where a camera is mounted
DONE, REFUSED, NO_BETTER = 0, 1, 3
Kind = Callable[[str], object]
EPILOGUE = f"Exit codes: {DONE} done, {REFUSED} refused, {NO_BETTER} no improvement."
URDF = "URDF file, or the name of an arm of example-robot-data"
WAYS = "ur, abb, kuka, fanuc, staubli, ros, matrix"
BOARD, CONE = Path("board/board.toml"), "45 deg"
BY_POSES = (
    *("pictures", "targets", "board", "lens", "convention", "target_convention", "height"),
    *("camera", "unit", "target_unit", "inverse"),
)  # options
OF_ARMS = "tool", "base", "description", "recording"
CALIBRATION = "folder of calibrate, or its correction.npz"


class Parser(argparse.ArgumentParser):
    """Reports errors as the commands do: in one sentence, with the same exit code."""

    def error(self, message: str) -> NoReturn:
        self.exit(REFUSED, f"recalib: {message}; try: {self.prog} --help\n")

    def add(
        self, name: str, text: str, kind: Kind = str, default: object = None, **more: Any
    ) -> None:
        """Add an argument, or an option whose help shows its default."""
        shown = "" if default is None else f" (default: {default})"
        self.add_argument(name, type=kind, default=default, help=text + shown, **more)


def parse(words: Sequence[str]) -> argparse.Namespace:
    """Parse a command line; exit with a code if it has a mistake."""
    parser = Parser(
        prog="recalib", description="Recalibrate a robot arm from measurements.", epilog=EPILOGUE
    )
    parser.add_argument("--version", action="version", version=f"recalib {__version__}")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")

    def add(name: str, text: str, out: str, epilog: str = "") -> Parser:
        own = commands.add_parser(
            name,
            help=text,
            description=text,
            epilog=f"{epilog}{EPILOGUE}",
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        folder = not Path(out).suffix  # a default without a suffix names a folder
        own.set_defaults(folder=folder)
        own.add("--out", f"new {'folder' if folder else 'file'} to write", Path, out)
        return own

    where = "where the camera is (default: fixed)"

    def add_arm(own: Parser) -> None:
        own.add("--tool", "tool link; needed only if the arm has several ends", _name)
        own.add("--base", "link whose frame poses are given in (default: the root)", _name)
        own.add("--description", "frames, columns and distances (TOML)", _path)
        own.add_argument(
            "--recording", action="store_true", help="also write recording.rrd, for rerun"
        )

    own = add(
        "calibrate", "identify the arm's parameters from measurements", "calibration", _columns()
    )
    own.add("urdf", f"{URDF}; not needed with --poses", _name, nargs="?")
    text = "table (CSV), or folders from recalib observe, one for each camera"
    own.add("measurements", text, _path, nargs="*")
    add_arm(own)
    group = own.add_argument_group("hand-eye calibration, without a URDF: see docs/poses.md")
    for name, kind, text in (
        ("--poses", _path, "table of the flange's poses in the base"),
        ("--pictures", _path, "folder of the board's pictures, one for each pose"),
        ("--targets", _path, "or table of the target's poses in the camera"),
        ("--board", _path, f"description of the board (default: {BOARD})"),
        ("--lens", _path, "lens calibration (default: estimated)"),
        ("--convention", str, f"notation of rotations: {WAYS}, or an order: ZYZ, xyz"),
        ("--target-convention", str, "notation of the target's rotations"),
        ("--height", str, "board height, if the arm turns about one axis: '31 cm +- 1 mm'"),
    ):
        group.add_argument(name, type=kind, help=text)
    group.add_argument("--camera", choices=CAMERAS, help=where)
    group.add_argument("--unit", choices=LENGTH.units, help="unit of positions, if not in headings")
    text = "unit of the target's positions (default: that of --unit)"
    group.add_argument("--target-unit", choices=LENGTH.units, help=text)
    text = "this table has the inverse poses: base in flange, or camera in target"
    group.add_argument("--inverse", choices=("flange", "targets"), action="append", help=text)

    text = "move, measure and calibrate until the predicted error is small enough"
    own = add("live", text, "calibration")
    own.add("station", "FILE.py:NAME, MODULE:NAME, or a quoted command line", _name)
    own.add("urdf", URDF, _name)
    own.add("--error", "end at this predicted error (default: when more rows would not help)")
    own.add("--most", "maximum number of rows", int, 60)
    own.add("--span", "largest distance of each joint from the first posture", str, "45 deg")
    text = "ranges of the tool's position: '-40 cm to 40 cm' '30 cm to 80 cm' '0 m to 1 m'"
    own.add("--box", text, nargs=3, metavar=("X", "Y", "Z"))
    own.add("--speed", "fraction of the fastest joint's limit", float, 0.1)
    own.add("--floor", "height of the floor in the arm's base, or none", str, "0 mm")
    own.add_argument("--no-self-collision", action="store_true", help="allow links near each other")
    own.add("--board", "board (TOML) in the pictures that the station measures", _path)
    own.add("--lens", "lens calibration (YAML), with --board", _path)
    own.add_argument("--camera", choices=CAMERAS, help=where)
    own.add_argument("--yes", action="store_true", help="move without asking")
    own.add("--table", "table of rows: new, or begun by live", _path, "measurements.csv")
    add_arm(own)

    own = add("correct", "compute commands that reach the desired poses", "commands.csv")
    own.add("calibration", CALIBRATION, _path)
    own.add("desired", "desired poses or joint coordinates (CSV)", _path)
    text = (
        "frame of the poses: instrument (poses of a target, as measured), or base (poses of the"
        " tool link; needs [instrument] in the description); default: instrument; for joints"
        " alone, and for balls in sockets: base"
    )
    own.add("--frame", text, choices=("base", "instrument"))

    text = "propose the most informative postures, and report whether more would help"
    own = add("next", text, "next.csv")
    own.add("calibration", CALIBRATION, _path)
    own.add(
        "candidates", "postures to choose from (CSV; default: drawn at random)", _path, nargs="?"
    )
    own.add("--count", "number of postures", _positive, 10)
    text = "propose flange poses, from a folder of calibrate --poses"
    own.add_argument("--poses", action="store_true", help=text)
    text = "with --poses: ranges of the flange's position: '-40 cm to 40 cm' ..."
    own.add("--box", text, nargs=3, metavar=("X", "Y", "Z"))
    text = f"with --poses: largest angle of view from the board's normal (default: {CONE})"
    own.add("--cone", text)

    own = add("urdf", "write a URDF from Denavit-Hartenberg parameters", "arm.urdf")
    own.add("links", "table (CSV): joint, a, alpha, d, theta, kind", _path)
    own.add("--convention", "standard or modified", str, "standard")

    own = add("board", "draw a ChArUco board to print", "board")
    own.add("--columns", "squares in a row", int, 7)
    own.add("--rows", "rows of squares", int, 5)
    own.add("--square", "width of a square", _length, "36 mm")

    own = add("observe", "find the board in pictures, and calibrate the lens", "observed")
    own.add("pictures", "folder of pictures", _path)
    own.add("joints", "table (CSV) of joint coordinates, with a column picture", _path)
    own.add("--board", "description of the board", _path, BOARD)
    own.add("--lens", "lens calibration (YAML; default: estimated)", _path)
    own.add_argument("--camera", choices=CAMERAS, default=FIXED, help=where)
    own.add("--name", "name of the camera, if there are several", str, "camera")

    if words and not words[0].startswith("-") and words[0] not in commands.choices:
        parser.error(str(UnknownName("command", words[0], commands.choices)))
    return parser.parse_args(words)


def _columns() -> str:
    """Text about the columns of a table of measurements, for `recalib calibrate --help`."""
    joint = "JOINT [deg]", "each joint by its name in the URDF, as the controller reports it"
    others = ((", ".join(columns.written), columns.meaning) for columns in MEASURED)
    lines = (f"  {headings:<48}{meaning}" for headings, meaning in (joint, *others))
    return "\n".join(["columns of a table of measurements:", *lines, "", ""])


def _name(text: str) -> str:
    if not text:
        raise argparse.ArgumentTypeError("'' is not a name")
    return text


def _path(text: str) -> Path:
    return Path(_name(text))


def _positive(text: str) -> int:
    if not text.isdecimal() or not int(text):
        raise argparse.ArgumentTypeError(f"{text!r} is not a positive whole number")
    return int(text)


def _length(text: str) -> float:
    try:
        return LENGTH.read(text)
    except InvalidQuantity as error:
        raise argparse.ArgumentTypeError(str(error)) from None
