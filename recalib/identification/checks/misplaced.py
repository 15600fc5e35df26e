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
    geometry: Calibration, frames: Frames, observations: Observations
) -> Iterator[tuple[str, np.ndarray]]:
    """The name of each such frame, and how far it is off (m, rad).

    `geometry` was identified from the same observations, with these frames as they are stated.
    """
    stated: list[np.ndarray | None] = []
    for unknown, prior, (_, turn) in (
        (frames.base_unknown, frames.base_prior, BASE),
        (frames.targets_unknown, frames.target_prior, LINK),
    ):
        given = prior if len(prior) else np.zeros(6)
        worn = np.where(given > EXACT, given, np.repeat([0.0, turn], 3))
        stated.append(None if unknown and not len(prior) else worn)
    loose = [None if one is None else np.array([UNKNOWN[0]] * 3 + [*one[3:]]) for one in stated]
    if all(one is None for one in loose):
        return
    arm, freed = geometry.model.nominal, frames.with_priors(*loose)
    (found,) = calibrations(arm, [OFFSETS], observations, freed)
    model, parameters = found.model, found.estimate.parameters
    shifts, as_stated = model.shifts(parameters), geometry.model.shifts(geometry.estimate.parameters)
    links = shifts[1 : len(arm.joints)]
    hidden = np.sum(links**2) < LESS * np.sum(as_stated**2)
    typical = np.sqrt(np.sum(links**2) / len(arm.joints))
    for number, slopes, _ in model.ends:
        end = min(number, 1)
        if (deviations := stated[end]) is None:
            continue
        moved, turned = (slopes @ model.twists(parameters)[number]).reshape(2, 3)
        shift = min(np.linalg.norm(moved), shifts[number])
        farthest = max(LEAST, FARTHER * typical, FAR * np.linalg.norm(deviations[:3]))
        if (hidden and shift > farthest) or (np.abs(turned) > FAR * deviations[3:]).any():
            yield ("instrument", "target")[end], np.array([shift, np.linalg.norm(turned)])
