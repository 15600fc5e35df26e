"""Hand-eye calibration: where cameras and boards are, how sure that is, and its errors."""

from collections.abc import Mapping

import numpy as np

from recalib.identification.hand_eye import Sights, calibrate_hand_eye
from recalib.identification.hand_eye import held_out as without_fold
from recalib.identification.held_out import HeldOut
from recalib.identification.validation import BLOCKWISE, WAYS
from recalib.laboratory.places import Place, hand_eye_places
from recalib.laboratory.report.templates import render
from recalib.laboratory.results import Results


def pixel_error(result: Results, kind: str, sight: int) -> float:
    """The mean over a sight's pictures, held out in blocks, of how far corners are off [px]."""
    observations, counted = result.data.observations, result.counted
    assert observations.optics is not None
    own = counted[observations.targets[counted] == sight]
    residuals = result.validation.held_out[BLOCKWISE][kind].residuals
    return float(observations.optics.moved(residuals)[own].mean())


def hand_eye(result: Results) -> str:
    """A TOML with all frames, held-out errors, and the same with the arm taken as right."""
    validation = result.validation
    held_out = {way: validation.held_out[way][validation.chosen] for way in WAYS}
    as_right, without = _arm_as_right(result, held_out)
    parts = ("", result.places, held_out), ("arm_as_right.", as_right, without)
    return render(
        "hand_eye.toml.j2",
        parts=[(prefix, places, _errors(result, errors)) for prefix, places, errors in parts],
    )


def _arm_as_right(
    result: Results, held_out: Mapping[str, HeldOut]
) -> tuple[list[Place], dict[str, HeldOut]]:
    """The places of cameras and boards by the nominal arm, and errors in the same folds.

    The first sight of a camera or a board determines its place.
    """
    data, arm = result.data, result.arm
    rows, links = data.observations, (arm.base, arm.tool)
    assert rows.measured is not None and rows.optics is not None
    flange, places = arm.forward(rows.joints), dict[str, Place]()
    residuals = {way: np.zeros((len(rows), 6)) for way in held_out}
    for sight, pair in enumerate(result.geometry.frames.sights):
        own = np.flatnonzero(rows.targets == sight)
        found = calibrate_hand_eye(Sights(flange, rows.measured, False, rows.optics)[own])
        for way, part in residuals.items():
            part[own] = without_fold(found, held_out[way].folds[own])
        names = data.instruments[pair[0]], data.target_names[pair[1]]
        for place in hand_eye_places(found, names, links):
            places.setdefault(place.name, place)
    errors = {way: HeldOut(residuals[way], held_out[way].folds, rows.optics) for way in held_out}
    return [*places.values()], errors


def _errors(result: Results, held_out: Mapping[str, HeldOut]) -> dict[str, tuple[float, float]]:
    """Mean errors by way of folding: of positions [m], and of corners [px]."""
    optics, means = result.data.observations.optics, {}
    assert optics is not None
    for way, errors in held_out.items():
        judged = result.validation.judged(way)
        off = errors[judged].errors[:, 0].mean(), optics.moved(errors.residuals)[judged].mean()
        means[way] = float(off[0]), float(off[1])
    return means
