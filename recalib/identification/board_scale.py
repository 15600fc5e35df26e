"""How large a board is, by an arm whose links are as long as they are described.

An arm whose links may have any length explains a board of any size: both scale together. So the
links are held here, and only joint offsets, frames and optics are found.
"""

from dataclasses import replace

import numpy as np

from recalib.identification.error_model import OFFSETS, ErrorModel
from recalib.identification.estimation import identify
from recalib.identification.frames import HELD, Frames
from recalib.identification.observations import Observations
from recalib.identification.optics import BOARD
from recalib.identification.repeatability import COVARIANCE
from recalib.nominal.kinematics import Arm

ANY = 0.5  # standard deviation of a scale that may be anything
LINKS = 2e-3  # rad, times a lever m: so far links that are held make an arm miss


def board_scale(arm: Arm, observations: Observations, frames: Frames) -> float:
    """The size of a board over that of its description; simulated arms tell it to 0.3 percent.

    Raises BadMeasurement, as `identify`.
    """
    assert observations.optics is not None
    deviations = observations.optics.deviations.copy()
    deviations[: len(BOARD)] = ANY
    model = ErrorModel(arm, OFFSETS, replace(frames, optics_deviations=deviations))
    held = ~model.free
    held[model.offset_columns] = False
    model.deviations[held] = HELD
    optics = observations.optics.with_noise(LINKS**2 * COVARIANCE)
    found = identify(model, replace(observations, optics=optics))
    return 1 + float(np.mean(found.parameters[model.optics_columns][: len(BOARD)]))
