"""The options of each command of `recalib`."""

import argparse
from collections.abc import Callable, Mapping
from pathlib import Path

CAMERAS = "fixed", "hand"
MAKING_FOLDERS = "calibrate", "live", "board", "observe"  # the other commands make a file
DONE, REFUSED, NO_BETTER = 0, 1, 3  # exit codes; argparse's own is 2
EPILOGUE = f"Exit codes: {DONE} done, {REFUSED} refused, {NO_BETTER} no better than doing nothing."
Command = Callable[[argparse.Namespace], int]
Kind = Callable[[str], object]


def parser_of(functions: Mapping[str, Command]) -> argparse.ArgumentParser:
    """What reads the command line, and calls one of these commands."""
    parser = argparse.ArgumentParser(
        prog="recalib", description="Recalibrate a robot arm from measurements.", epilog=EPILOGUE
    )
    commands = parser.add_subparsers(required=True, metavar="COMMAND")

    def add(name: str, text: str) -> argparse.ArgumentParser:
        own = commands.add_parser(name, help=text, description=text, epilog=EPILOGUE)
        own.set_defaults(command=functions[name], makes_folder=name in MAKING_FOLDERS)
        return own

    def add_default(
        own: argparse.ArgumentParser, name: str, default: object, text: str, kind: Kind = str
    ) -> None:
        own.add_argument(name, default=default, type=kind, help=f"{text} (default: {default})")

    def add_arm(own: argparse.ArgumentParser) -> None:
        own.add_argument(
            "--tool", type=_name, help="tool link; needed only if the arm has several ends"
        )
        own.add_argument(
            "--base", type=_name, help="link whose frame poses are given in (default: the root)"
        )
        own.add_argument("--description", type=_path, help="frames, columns and distances (TOML)")
        add_default(own, "--out", "calibration", "new folder to write")

    urdf = "URDF file, or the name of an arm of example-robot-data"
    own = add("calibrate", "identify the arm's parameters from measurements")
    own.add_argument("urdf", type=_name, help=urdf)
    own.add_argument(
        "measurements",
        type=_path,
        nargs="+",
        help="table (CSV), or the folders that observe wrote, one for each camera",
    )
    add_arm(own)

    own = add("live", "move, measure and calibrate until the predicted error is small enough")
    own.add_argument(
        "station", type=_name, help="FILE.py:NAME, MODULE:NAME, or a quoted command line"
    )
    own.add_argument("urdf", type=_name, help=urdf)
    own.add_argument("--error", help="predicted error to end at, such as '0.3 mm'")
    add_default(own, "--most", 60, "rows to end at in any case", int)
    add_default(own, "--span", "45 deg", "range of each joint about the first posture, either way")
    own.add_argument(
        "--box", help="ranges of the tool's x, y, z: '-40 cm to 40 cm, 30 cm to 80 cm, 0 m to 1 m'"
    )
    add_default(own, "--speed", 0.1, "share of the possible speed", float)
    floor = "height in the arm's base that all stays above, or none"
    add_default(own, "--floor", "0 mm", floor)
    own.add_argument(
        "--no-self-collision", action="store_true", help="let links come near each other"
    )
    own.add_argument("--board", type=_path, help="board in the station's pictures (TOML)")
    own.add_argument("--lens", type=_path, help="lens calibration (YAML), with --board")
    own.add_argument("--camera", choices=CAMERAS, help="where it is (default: fixed)")
    own.add_argument("--yes", action="store_true", help="move without asking")
    add_default(own, "--table", "measurements.csv", "new, or begun by live", _path)
    add_arm(own)

    own = add("correct", "compute commands that reach the desired poses")
    own.add_argument("calibration", type=_path, help="folder of calibrate, or its correction.npz")
    own.add_argument("desired", type=_path, help="desired poses or joint coordinates (CSV)")
    own.add_argument(
        "--frame",
        choices=("base", "instrument"),
        default="base",
        help="frame of the poses: the tool link in the base, or a target in the instrument's frame"
        " (default: %(default)s)",
    )
    add_default(own, "--out", "commands.csv", "new file to write")

    own = add(
        "next",
        "propose the most informative postures, and say whether more are worth measuring",
    )
    own.add_argument("calibration", type=_path, help="folder of calibrate, or its correction.npz")
    own.add_argument(
        "candidates",
        type=_path,
        nargs="?",
        help="postures to choose from (CSV); drawn unless given",
    )
    add_default(own, "--count", 10, "number of postures", _positive)
    add_default(own, "--out", "next.csv", "new file to write")

    own = add("urdf", "write a URDF from Denavit-Hartenberg parameters")
    own.add_argument("links", type=_path, help="table (CSV): joint, a, alpha, d, theta, kind")
    add_default(own, "--convention", "standard", "standard or modified")
    add_default(own, "--out", "arm.urdf", "new file to write")

    own = add("board", "draw a calibration board to print")
    add_default(own, "--kind", "charuco", "charuco or apriltag")
    add_default(own, "--columns", 7, "squares in a row", int)
    add_default(own, "--rows", 5, "rows of squares", int)
    add_default(own, "--square", "36 mm", "width of a square")
    add_default(own, "--out", "board", "new folder to write")

    own = add("observe", "find the board in pictures, and calibrate the lens")
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
    add_default(own, "--out", "observed", "new folder to write")
    return parser


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
