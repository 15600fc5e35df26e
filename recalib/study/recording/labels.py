"""Labels of damages: they stand outside of the arm and of the workspace, with leaders to them."""

from collections.abc import Sequence

import numpy as np
import rerun as rr

from recalib.study.recording.colours import WRONG
from recalib.study.recording.phases import BEFORE
from recalib.study.recording.scene import Scene, unit_of

# of a picture whose half is 1 high
ASIDE, ABOVE = 0.9, 0.84  # the first label of a column
GAP = 0.11  # from one label of a column to the next
LETTER, LINE = 0.0122, 0.04  # half a letter's width and a line's height, about
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
    aside, above = sight.seen(starts[:, waits]).T
    for side in (-1, 1):
        column = np.flatnonzero(np.where(aside > above, 1, -1) == side)
        # as high above one another as what they label: few leaders cross
        for place, label in enumerate(column[np.argsort(side * above[column])]):
            across, up = side * ASIDE, side * (GAP * place - ABOVE)
            at = sight.place(across, up)
            point = rr.Points3D([at], radii=0, colors=WRONG, labels=[words[label]])
            scene.log(f"wrong/{label}/label", point)
            end = sight.place(across - side * LETTER * len(words[label]), up - LINE)
            strips = np.stack([starts[label], np.broadcast_to(end, starts[label].shape)], axis=1)
            leader = f"wrong/{label}/leader"
            scene.send(leader, scene.motion.clock(), rr.LineStrips3D.columns(strips=strips))
            scene.log(leader, rr.LineStrips3D.from_fields(colors=WRONG, radii=LEADER * unit))
