"""How large boards are, by an arm whose links are as long as they are described.

An arm whose links may have any length explains a board of any size: both scale together. So the
links are held here, and only joint offsets, frames and optics are found.
"""

from collections.abc import Sequence
from dataclasses import replace

from recalib.identification.error_model import OFFSETS, ErrorModel
from recalib.identification.estimation import identify
from recalib.identification.frames import HELD, Frames
from recalib.identification.observations import Observations
from recalib.identification.optics import BOARD
from recalib.identification.repeatability import COVARIANCE
from recalib.nominal.kinematics import Arm

ANY = 0.5  # standard deviation of a scale that may be anything
LINKS = 2e-3  # rad, times a lever m: so far links that are held make an arm miss


def board_scales(arm: Arm, observations: Observations, frames: Frames) -> Sequence[float]:
    """The size of each board over that of its description; simulated arms tell it to 0.3 percent.

    Args:
        frames: an initial estimate of them, with optics.

    Raises BadMeasurement, as `identify`.
    """
    assert observations.optics is not None
    model, boards = ErrorModel(arm, OFFSETS, frames), frames.optics_kinds < len(BOARD)
    model.deviations[model.optics_columns][boards] = ANY
    held = ~model.free
    held[model.offset_columns] = False
    model.deviations[held] = HELD
    optics = observations.optics.with_noise(LINKS**2 * COVARIANCE)
    found = identify(model, replace(observations, optics=optics))
    scales = found.parameters[model.optics_columns][boards].reshape(-1, len(BOARD))
    return (1 + scales.mean(axis=1)).tolist()
