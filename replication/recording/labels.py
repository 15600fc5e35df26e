"""Labels of damages: they stand outside of the arm and of the workspace, with leaders to them."""

from collections.abc import Sequence

import numpy as np
import rerun as rr

from replication.recording.colours import WRONG
from replication.recording.phases import BEFORE
from replication.recording.scene import Scene, unit_of

# of a picture whose half is 1 high
ASIDE, ABOVE = 0.94, 0.88  # the first label of a column
GAP = 0.11  # from one label of a column to the next
LETTER, LINE = 0.0122, 0.04  # half a letter's width and a line's height, about
BESIDE = 0.045  # words, for in a small window they are larger
LEADER = 0.007  # radius, in units of `unit_of`


def send_labels(scene: Scene, words: Sequence[str], starts: np.ndarray) -> None:
    """Labels in two columns, and leaders to them that follow the arm.

    One goes down from the upper corner beyond the workspace, the other one up from the lower corner
    behind the base. Each label stands in the nearer one.

    Args:
        starts: (label, frame, 3) m, where their leaders start.
    """
    sight, unit = scene.sight, unit_of(scene.workspace)
    waits = np.sum(scene.motion.frames < BEFORE)
    projected = sight.projected(starts[:, waits])
    for side in (-1, 1):
        column = np.flatnonzero(np.where(projected[:, 0] > projected[:, 1], 1, -1) == side)
        for place, label in enumerate(column[in_order(side, projected[column])]):
            at = np.array([side * ASIDE, side * (GAP * place - ABOVE)])
            point = rr.Points3D([sight.place(*at)], radii=0, colors=WRONG, labels=[words[label]])
            scene.log(f"wrong/{label}/label", point)
            half = LETTER * len(words[label]) + BESIDE
            end = sight.place(
                *leader_end(side, at, half, projected[label], place == len(column) - 1)
            )
            strips = np.stack([starts[label], np.broadcast_to(end, starts[label].shape)], axis=1)
            leader = f"wrong/{label}/leader"
            scene.send(leader, scene.motion.clock(), rr.LineStrips3D.columns(strips=strips))
            scene.log(leader, rr.LineStrips3D.from_fields(colors=WRONG, radii=LEADER * unit))


def in_order(side: int, starts: np.ndarray) -> np.ndarray:
    """The order of a column's labels, from its corner on, in which no leader crosses another one.

    Args:
        side: of the picture, -1 or 1.
        starts: (label, 2) in the picture.
    """
    inwards, along = (side * np.array([ASIDE, -ABOVE]) - starts).T * [[side], [-side]]
    return np.argsort(np.arctan2(along, inwards))


def leader_end(side: int, at: np.ndarray, half: float, start: np.ndarray, free: bool) -> np.ndarray:
    """Where in the picture a leader meets its label: at its inner side.

    Args:
        at: (2,), where the label stands: its words are below.
        half: its words' width.
        start: (2,) of the leader.
        free: whether the label has none between it and the middle of the picture: a leader that
            starts beyond its inner side comes to it from there, and not through its words.
    """
    inner, middle = at[0] - side * half, at[1] - LINE
    if free and side * (start[0] - inner) > 0:
        return np.array(
            [start[0].clip(*sorted((inner, at[0] + side * half))), middle + side * LINE]
        )
    return np.array([inner, middle])
