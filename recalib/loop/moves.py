"""Checks of achieved poses before a learner uses them.

A NaN, or millimetres instead of metres, would silently spoil everything that is learned. All
learners use the same `check_moves`.
"""

import numpy as np

from recalib.errors import BadMeasurement
from recalib.numerics.compiled import compiled

# Workspace coordinates; the workspace reaches from -1 to 1. Links 12 cm too short and encoders 12
# degrees off cause errors of 1 or 2. A pose at 5 is twice the size of the workspace away from it.
OUTSIDE = 5.0
# Angles wrap: a commanded turn beyond 180 degrees is measured as a smaller one. A pitch beyond 90
# degrees is measured as roll and yaw of up to 180 degrees, which is at most twice as much.
WRAPPED = 2.0
MOVED, STUCK = 0.1, 0.01  # commands at least MOVED apart, poses less than STUCK apart: a stuck arm
Moves = tuple[np.ndarray, np.ndarray, np.ndarray]  # commands, achieved, executed
NO_MOVES: Moves = np.empty((0, 1, 6)), np.empty((0, 1, 6)), np.empty((0, 1), dtype=bool)


def check_moves(
    commands: np.ndarray, achieved: np.ndarray, executed: np.ndarray, last: Moves | None = None
) -> Moves:
    """Raise BadMeasurement if achieved poses are not numbers, are far off, or do not change.

    Args:
        commands, achieved: (run, move, 6) coordinates of the workspace. Refused moves are checked,
            too: their pose is home.
        executed: (run, move) whether each move was executed.
        last: the previous move, as this function returned it.

    Returns the last move: commands, achieved and executed, with a move axis of 1.
    """
    moves = commands, achieved, np.asarray(executed)
    run, move, stuck = _first_wrong(*moves, *(last or NO_MOVES))
    if run >= 0:
        # A command may be NaN if a learner diverges; such a move is refused, and harmless.
        allowed = OUTSIDE + WRAPPED * np.abs(commands[run, move]).max()
        valid = (
            "six coordinates of the workspace, which reaches from -1 to 1, each a number up to"
            f" {allowed:.3g} for such a command"
        )
        if stuck:
            valid = "a pose that differs from that of the previous move, as the commands do"
        raise BadMeasurement(f"move {move} of run {run}", achieved[run, move], valid)
    if commands.shape[1] > 1:  # compiled loops need contiguous arrays
        return commands[:, -1:].copy(), achieved[:, -1:].copy(), executed[:, -1:].copy()
    return commands, achieved, executed


@compiled
def _first_wrong(
    commands: np.ndarray,
    achieved: np.ndarray,
    executed: np.ndarray,
    last_commands: np.ndarray,
    last_achieved: np.ndarray,
    last_executed: np.ndarray,
) -> tuple[int, int, bool]:
    """Run and move of the first bad pose, and whether the arm was stuck; -1 if all are good."""
    for run in range(achieved.shape[0]):
        for move in range(achieved.shape[1]):
            allowed, size = 0.0, 0.0
            for number in range(6):
                allowed = max(allowed, abs(commands[run, move, number]))
            allowed = OUTSIDE + WRAPPED * allowed
            for number in range(6):
                size = abs(achieved[run, move, number])
                if size > allowed or not np.isfinite(size):
                    return run, move, False
            if move == 0 and not len(last_commands):
                continue
            command = commands[run, move - 1] if move > 0 else last_commands[run, 0]
            pose = achieved[run, move - 1] if move > 0 else last_achieved[run, 0]
            done = executed[run, move - 1] if move > 0 else last_executed[run, 0]
            gap, sent = 0.0, 0.0
            for number in range(6):
                gap = max(gap, abs(achieved[run, move, number] - pose[number]))
                sent = max(sent, abs(commands[run, move, number] - command[number]))
            if gap < STUCK and sent > MOVED and executed[run, move] and done:
                return run, move, True
    return -1, -1, False
