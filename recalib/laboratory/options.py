"""The options of each command of `recalib`."""

import argparse
from collections.abc import Callable, Mapping
from pathlib import Path

CAMERAS = "fixed", "hand"
MAKING_FOLDERS = "calibrate", "live", "board", "observe"  # the other commands make a file
DONE, REFUSED, NO_BETTER = 0, 1, 3  # exit codes; argparse's own is 2
EPILOGUE = f"Exit codes: {DONE} done, {REFUSED} refused, {NO_BETTER} no better than doing nothing."
Command = Callable[[argparse.Namespace], int]


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

    own = add("correct", "compute commands that reach the desired poses")
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

    own = add("urdf", "write a URDF from Denavit-Hartenberg parameters")
    own.add_argument("links", type=_path, help="table (CSV): joint, a, alpha, d, theta, kind")
    own.add_argument(
        "--convention", default="standard", help="standard or modified (default: %(default)s)"
    )
    own.add_argument("--out", default="arm.urdf", help="new file to write (default: %(default)s)")

    own = add("board", "draw a calibration board to print")
    own.add_argument("--kind", default="charuco", help="charuco or apriltag (default: %(default)s)")
    own.add_argument(
        "--columns", type=int, default=7, help="squares in a row (default: %(default)s)"
    )
    own.add_argument("--rows", type=int, default=5, help="rows of squares (default: %(default)s)")
    own.add_argument("--square", default="36 mm", help="width of a square (default: %(default)s)")
    own.add_argument("--out", default="board", help="new folder to write (default: %(default)s)")

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
    own.add_argument("--out", default="observed", help="new folder to write (default: %(default)s)")
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
