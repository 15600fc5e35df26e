"""Checks of what moves achieved, before a learner learns from it: unusable numbers are refused.

A NaN would spread silently through everything learned from it, and so would millimetres taken for
metres. All learners use the same `check_moves`.
"""

import numpy as np

from recalib.errors import BadMeasurement
from recalib.numerics.compiled import compiled

# Workspace coordinates; the workspace reaches from -1 to 1. Links 12 cm too short and encoders 12
# degrees off move an arm by 1 or 2. At 5 it is away by twice the size of the workspace.
OUTSIDE = 5.0
# A command beyond half a turn comes back as a smaller one. One beyond a quarter of a turn about the
# middle axis comes back as up to half a turn about the others, which is at most twice as much.
WRAPPED = 2.0
MOVED, STUCK = 0.1, 0.01  # commands so far apart do not lead to poses so close together
Moves = tuple[np.ndarray, np.ndarray, np.ndarray]  # commands, achieved, executed
NO_MOVES: Moves = np.empty((0, 1, 6)), np.empty((0, 1, 6)), np.empty((0, 1), dtype=bool)


def check_moves(
    commands: np.ndarray, achieved: np.ndarray, executed: np.ndarray, last: Moves | None = None
) -> Moves:
    """Raise BadMeasurement unless what moves achieved are numbers, no arm's length off, and differ.

    Args:
        commands, achieved: (run, move, 6) coordinates of the workspace. A refused move counts,
            too: it leaves the arm at home.
        executed: (run, move) whether it was carried out.
        last: the move before these, as this function returned it.

    Returns the last of these moves, commands, achieved and executed, with a move axis of 1.
    """
    moves = commands, achieved, np.asarray(executed)
    run, move, stuck = _first_wrong(*moves, *(last or NO_MOVES))
    if run >= 0:
        # A command may be NaN where a learner diverges; such a move is refused, and harmless.
        allowed = OUTSIDE + WRAPPED * np.abs(commands[run, move]).max()
        valid = (
            "six coordinates of the workspace, which reaches from -1 to 1, each a number up to"
            f" {allowed:.3g} for such a command"
        )
        if stuck:
            valid = "another pose than the move before it, whose command was another one"
        raise BadMeasurement(f"move {move} of run {run}", achieved[run, move], valid)
    if commands.shape[1] > 1:  # compiled loops want whole arrays
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
    """Run and move of the first that achieved no numbers, or was too far off; -1 if none.

    Or, with the third value true, of the first that led to the pose before it by another command.
    """
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
            before = commands[run, move - 1] if move > 0 else last_commands[run, 0]
            there = achieved[run, move - 1] if move > 0 else last_achieved[run, 0]
            done = executed[run, move - 1] if move > 0 else last_executed[run, 0]
            gap, sent = 0.0, 0.0
            for number in range(6):
                gap = max(gap, abs(achieved[run, move, number] - there[number]))
                sent = max(sent, abs(commands[run, move, number] - before[number]))
            if gap < STUCK and sent > MOVED and executed[run, move] and done:
                return run, move, True
    return -1, -1, False
