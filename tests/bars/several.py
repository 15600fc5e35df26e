"""What several cameras are worth, and which slips are named: python -m tests.bars.several.

The Panda of `tests.bars.pictures`, with 30 pictures by each camera, whose lens is sought. A slip is
by 1 mm or by 0.2 degrees, after half of the pictures; it is named where that picture is, too.
"""

from collections.abc import Callable, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from recalib.laboratory.calibrate import Calibrated
from recalib.laboratory.pictures.sessions import calibrate_pictures
from tests.bars.pictures import Draw
from tests.vision.rendering import Cell
from tests.vision.sessions import PICTURES, SHIFT, SMALL, TURN, beside, write_session

# By what is in one fit, of a seed its sessions: see `write_session`.
Sessions = Callable[[int], Sequence[tuple]]
SETUPS: dict[str, Sessions] = {
    "one fixed": lambda seed: [(Cell(seed), "left")],
    "one on the hand": lambda seed: [(Cell(seed, True), "hand")],
    "two fixed": lambda seed: [(Cell(seed), "left"), (beside(seed), "right")],
    "one fixed, one on the hand": lambda seed: [
        (Cell(seed), "left", "tool"),
        (Cell(seed, True, SMALL), "hand", "table"),
    ],
}
SLIPS = {  # a setup, and what slips in its last session
    "the board, seen by a fixed camera": ("one fixed", "sheet"),
    "the camera on the hand": ("one on the hand", "eye"),
    "the board, seen by one of two fixed cameras": ("two fixed", "sheet"),
    "the camera on the hand, with a fixed one": ("one fixed, one on the hand", "eye"),
}


def calibration(sessions: Sequence[tuple], slip: tuple | None = None) -> Calibrated:
    """By sessions, of which something slips in the last one."""
    with TemporaryDirectory() as folder:
        *others, (cell, camera, *board) = sessions
        observed = [write_session(Path(folder) / session[1], *session) for session in others]
        last = write_session(Path(folder) / camera, cell, camera, *board, slip=slip)
        return calibrate_pictures("panda.urdf", [*observed, last], tool="panda_link8")


def main(draws: int = 20) -> None:
    """Print errors of each setup, false alarms, and which slips are named."""
    print("| cameras | error | largest | false alarms |")
    print("| --- | --- | --- | --- |")
    for name, sessions in SETUPS.items():
        errors, false_alarms = [], 0
        for seed in range(draws):
            result, draw = calibration(sessions(seed)), Draw(seed, False)
            errors.append(draw.judge(result.geometry.forward(draw.fresh))[0])
            false_alarms += bool(result.faults)
        print(
            f"| {name} | {np.median(errors):.3g} | {max(errors):.3g} | {false_alarms} of {draws} |"
        )
    print("| what slips | 1 mm | 0.2 degrees |")
    print("| --- | --- | --- |")
    for name, (setup, place) in SLIPS.items():
        named = [0, 0]
        for seed in range(draws):
            right = [("slip", PICTURES // 2, len(SETUPS[setup](seed)) - 1)]
            for number, motion in enumerate((SHIFT, TURN)):
                faults = calibration(SETUPS[setup](seed), (place, motion)).faults
                named[number] += [(fault.kind, fault.row, fault.sight) for fault in faults] == right
        print(f"| {name} | {' | '.join(f'{count} of {draws}' for count in named)} |")


if __name__ == "__main__":
    main()
