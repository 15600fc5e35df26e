"""The same by this project: as `recalib calibrate` does it, and by plain least squares."""

import numpy as np

from recalib.identification.error_model import OFFSETS, ErrorModel
from recalib.identification.first_guess import guess_frames
from recalib.identification.validation import GEOMETRIC, validate
from tests.identification.bars import least_squares
from tests.peers.tasks import Task

NOMINAL, PLAIN, GEOMETRY, OURS = "nominal", "plain least squares", "recalib, geometry", "recalib"


def predict_all(task: Task) -> dict[str, np.ndarray]:
    """Positions (m, 3) [m] in the fresh postures, by who predicts them."""
    guess = guess_frames(task.arm, task.seen)
    model = ErrorModel(task.arm, OFFSETS, guess)
    plain = model.predict(least_squares(model, task.seen), task.fresh)
    validation = validate(task.arm, task.seen, guess)
    poses = {
        PLAIN: plain,
        GEOMETRY: validation.full[GEOMETRIC].seen(task.fresh),
        OURS: validation.calibration.seen(task.fresh),
    }
    found = {who: task.predicted(its) for who, its in poses.items()}
    nominal = task.nominal()
    return found if nominal is None else {NOMINAL: nominal} | found
