"""Frames that are not where they are stated to be.

Wear of links may explain the same rows. So links are identified again, with frames that may be
anywhere: a frame is misplaced if far less wear remains.
"""

from collections.abc import Iterator

import numpy as np

from recalib.identification.calibration import Calibration, calibrations
from recalib.identification.model.error_model import OFFSETS
from recalib.identification.model.frames import BASE, EXACT, LINK, UNKNOWN, Frames
from recalib.identification.model.observations import Observations

LEAST, FARTHER = 3e-3, 4.0  # m, and times the typical shift of a link: the least shift of a frame
LESS = 0.4  # links must explain less of all squared shifts
FAR = 3.0  # stated deviations


def misplaced(
    geometry: Calibration, frames: Frames, rows: Observations
) -> Iterator[tuple[str, np.ndarray]]:
    """The name of each such frame, and how far it is off (m, rad).

    `geometry` was identified from the same rows, with these frames as they are stated.
    """
    arm, loose, stated = geometry.model.nominal, {}, {}
    for name, unknown, prior, (_, worn) in (
        ("instrument", frames.base_unknown, frames.base_prior, BASE),
        ("target", frames.targets_unknown, frames.target_prior, LINK),
    ):
        if len(prior) or not unknown:
            given = prior if len(prior) else np.zeros(6)
            turns = np.where(given[3:] > EXACT, given[3:], worn)
            loose[name] = np.array([UNKNOWN[0]] * 3 + [*turns])
            stated[name] = np.linalg.norm(given[:3]), np.linalg.norm(turns)
    if not loose:
        return
    freed = frames.with_priors(loose.get("instrument"), loose.get("target"))
    (found,) = calibrations(arm, [OFFSETS], rows, freed)
    twists = found.model.twists(found.estimate.parameters)
    shifts = found.model.shifts(found.estimate.parameters)
    count, links = len(arm.joints), np.sum(shifts[1 : len(arm.joints)] ** 2)
    hidden = links < LESS * np.sum(geometry.model.shifts(geometry.estimate.parameters) ** 2)
    # a tilt of the base moves one of both ends of the way to a distant instrument, but not both
    shifts[0] = min(shifts[0], np.linalg.norm(twists[0, :3]))
    for name, (length, angle) in stated.items():
        twist = 0 if name == "instrument" else count
        shift, turn = shifts[twist], np.linalg.norm(twists[twist, 3:])
        farthest = max(LEAST, FARTHER * np.sqrt(links / count), FAR * length)
        if (hidden and shift > farthest) or turn > FAR * angle:
            yield name, np.array([shift, turn])
