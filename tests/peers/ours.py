"""The same by this project: as `recalib calibrate` does it, and by plain least squares."""

import numpy as np

from recalib.identification.initial_estimate import initial_frames
from recalib.identification.model.error_model import OFFSETS, ErrorModel
from recalib.identification.model.linearisation import Linearisation
from recalib.identification.model.observations import Observations
from recalib.identification.validation import GEOMETRIC, validate
from tests.identification.real import NOISE
from tests.peers.tasks import Task

NOMINAL, PLAIN, GEOMETRY, OURS = "nominal", "plain least squares", "recalib, geometry", "recalib"


def predict_all(task: Task) -> dict[str, np.ndarray]:
    """Positions (m, 3) [m] in the fresh postures, by who predicts them."""
    guess = initial_frames(task.arm, task.observations)
    model = ErrorModel(task.arm, OFFSETS, guess)
    plain = model.predict(least_squares(model, task.observations), task.fresh)
    validation = validate(task.arm, task.observations, guess)
    poses = {
        PLAIN: plain,
        GEOMETRY: validation.full[GEOMETRIC].predict(task.fresh),
        OURS: validation.calibration.predict(task.fresh),
    }
    predictions = {who: task.predicted(predicted) for who, predicted in poses.items()}
    nominal = task.nominal()
    return predictions if nominal is None else {NOMINAL: nominal} | predictions


def least_squares(model: ErrorModel, observations: Observations) -> np.ndarray:
    """Parameters without a prior: of all that fit best, the smallest. It starts at nominal."""
    parameters, terms = np.zeros_like(model.deviations), model.terms(observations.joints)
    for _ in range(10):
        linear = Linearisation(model, parameters, observations, terms)
        scales = np.array(NOISE)[: observations.kinds, None, None]
        rows = (linear.jacobians / scales[..., None]).reshape(-1, len(parameters))
        goal = (linear.residuals / scales).ravel()
        parameters = parameters + np.linalg.lstsq(rows, goal, rcond=1e-7)[0]
    return parameters * model.deviations
