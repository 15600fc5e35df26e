"""How long links are: the distances between the origins of neighbouring joints.

An origin may lie anywhere on its joint's axis, and that of a joint that slides anywhere at all: no
measurement says where. So the origins of an identified arm are moved, as far as they may be, to
where its links are most like the nominal ones. What still differs does so wherever origins lie.
"""

import numpy as np

from recalib.nominal.kinematics import Arm

# Axes as near to parallel count as parallel: far away along them, any length would be explained.
PARALLEL = 0.02


def link_lengths(nominal: Arm, identified: Arm) -> tuple[np.ndarray, np.ndarray]:
    """Lengths (joints - 1,) [m] of the links from each joint to the next, of both arms."""
    placements = [list(arm.model.jointPlacements)[2:] for arm in (nominal, identified)]
    right, found = (np.array([its.translation for its in arm]).reshape(-1, 3) for arm in placements)
    free = [  # directions in which each origin may be moved, in the frame of its joint
        np.eye(3) if slides else np.outer(axis, axis)
        for slides, axis in zip(nominal.slides, nominal.axes, strict=True)
    ]
    columns = np.zeros((*found.shape, len(free), 3))
    for link, placement in enumerate(placements[1]):
        columns[link, :, link] = -free[link]
        columns[link, :, link + 1] = placement.rotation @ free[link + 1]
    slopes = columns.reshape(found.size, 3 * len(free))
    moves = slopes @ np.linalg.lstsq(slopes, (right - found).ravel(), rcond=PARALLEL)[0]
    return np.linalg.norm(right, axis=1), np.linalg.norm(found + moves.reshape(-1, 3), axis=1)
