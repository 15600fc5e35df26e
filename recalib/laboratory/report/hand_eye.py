"""Hand-eye calibration: where cameras and boards are, how sure that is, and what it is worth."""

from collections.abc import Mapping

from recalib.identification.arm_as_right import arm_as_right
from recalib.identification.held_out import HeldOut
from recalib.identification.validation import WAYS
from recalib.laboratory.report.forms import Forms
from recalib.laboratory.report.templates import render
from recalib.laboratory.results import Results


def pixel_error(result: Results, way: str, kind: str, sight: int | None = None) -> float:
    """The mean over held-out pictures of how far corners are off [px], each a root mean square.

    Args:
        sight: the number of a camera's sight of a board; all of them by default.
    """
    observations, counted = result.data.observations, result.counted
    assert observations.optics is not None
    if sight is not None:
        counted = counted[observations.targets[counted] == sight]
    residuals = result.validation.held_out[way][kind].residuals
    return float(observations.optics.moved(residuals)[counted].mean())


def hand_eye(result: Results) -> str:
    """A TOML with all frames, held-out errors, and the same with the arm taken as right."""
    validation = result.validation
    held_out = {way: validation.held_out[way][validation.chosen] for way in WAYS}
    folds = {way: errors.folds for way, errors in held_out.items()}
    as_right, without = arm_as_right(result.geometry, result.data.observations, folds)
    places = result.places_by(as_right, [], result.arm.tool)
    parts = (
        ("", result.places, _errors(result, held_out)),
        ("arm_as_right.", places, _errors(result, without)),
    )
    return render("hand_eye.toml.j2", parts=parts, forms=Forms)


def _errors(result: Results, held_out: Mapping[str, HeldOut]) -> dict[str, tuple[float, float]]:
    """Mean errors by way of folding: of positions [m], and of corners [px]."""
    optics, means = result.data.observations.optics, {}
    assert optics is not None
    for way, errors in held_out.items():
        judged = result.validation.judged(way)
        off = errors[judged].errors[:, 0].mean(), optics.moved(errors.residuals)[judged].mean()
        means[way] = float(off[0]), float(off[1])
    return means
