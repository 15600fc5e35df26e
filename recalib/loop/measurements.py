"""Checks of measurements before learning: unusable ones are refused by name.

A NaN would spread silently through everything learned from it, and so would millimetres taken for
metres. All learners use the same `check_moves`.
"""

import numpy as np

from recalib.errors import BadMeasurement

FARTHEST = 10.0  # m from where the tool should be: that is no arm, or not in metres
# Workspace coordinates; the workspace reaches from -1 to 1. Links 12 cm too short and encoders 12
# degrees off move an arm by 1 or 2. At 5 it is away by twice the size of the workspace.
OUTSIDE = 5.0
# A command beyond half a turn comes back as a smaller one. One beyond a quarter of a turn about the
# middle axis comes back as up to half a turn about the others, which is at most twice as much.
WRAPPED = 2.0
MOVED, STUCK = 0.1, 0.01  # commands so far apart do not lead to poses so close together
SKEW = 0.01  # of a rotation matrix, as instruments round it
POSE = "a rotation and a position, above a row of 0, 0, 0, 1"
Moves = tuple[np.ndarray, np.ndarray, np.ndarray]  # commands, achieved, executed


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
    allowed = OUTSIDE + WRAPPED * np.abs(commands).max(axis=-1)
    size = np.abs(achieved).max(axis=-1)
    # A command may be NaN where a learner diverges; such a move is refused, and harmless.
    bad = ~np.isfinite(size) | (size > allowed)
    if bad.any():
        run, move = np.argwhere(bad)[0]
        valid = (
            "six coordinates of the workspace, which reaches from -1 to 1, each a number up to"
            f" {allowed[run, move]:.3g} for such a command"
        )
        raise BadMeasurement(f"move {move} of run {run}", achieved[run, move], valid)
    if last is not None:
        commands, achieved, executed = (
            np.concatenate(parts, axis=1)
            for parts in zip(last, (commands, achieved, executed), strict=True)
        )
    _check_differ(commands, achieved, executed, first=int(last is None))
    return commands[:, -1:], achieved[:, -1:], executed[:, -1:]


def _check_differ(
    commands: np.ndarray, achieved: np.ndarray, executed: np.ndarray, first: int
) -> None:
    """Raise BadMeasurement where another command led to the same pose; `first`: the second move."""
    alike = np.abs(achieved[:, 1:] - achieved[:, :-1]).max(axis=-1) < STUCK
    if not alike.any():
        return
    sent = np.abs(commands[:, 1:] - commands[:, :-1]).max(axis=-1)
    stuck = alike & (sent > MOVED) & executed[:, 1:] & executed[:, :-1]
    for run, move in np.argwhere(stuck)[:1]:
        valid = "another pose than the move before it, whose command was another one"
        raise BadMeasurement(f"move {move + first} of run {run}", achieved[run, move + 1], valid)


def check_pose(measured: np.ndarray, expected: np.ndarray) -> None:
    """Raise BadMeasurement unless a measured pose is one, and not grossly off.

    Args:
        measured: (4, 4) m in the base frame, if it is as it should be.
        expected: (4, 4) likewise, to which it must be near.
    """
    if np.shape(measured) != (4, 4):
        valid = "a matrix (4, 4)"
    elif not np.isfinite(measured).all():
        valid = "numbers"
    elif not are_poses(measured):
        valid = POSE
    elif np.linalg.norm(measured[:3, 3] - expected[:3, 3]) > FARTHEST:
        valid = f"m in the base frame, at most {FARTHEST:g} m from the workspace's centre"
    else:
        return
    raise BadMeasurement("the robot", np.ravel(measured), valid)


def are_poses(matrices: np.ndarray) -> np.ndarray:
    """Whether matrices (..., 4, 4) are poses, (...): none is transposed, mirrored or scaled."""
    turns = matrices[..., :3, :3]
    skew = np.abs(turns @ turns.swapaxes(-2, -1) - np.eye(3)).max(axis=(-2, -1))
    ends = (matrices[..., 3, :] == [0, 0, 0, 1]).all(axis=-1)
    return ends & (skew < SKEW) & (np.linalg.det(turns) > 0)
