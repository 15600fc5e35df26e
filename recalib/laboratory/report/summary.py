"""The summary of a calibration: held-out errors, the identified arm, and warnings."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from recalib.identification.held_out import HeldOut
from recalib.identification.validation import (
    BLOCKWISE,
    GEOMETRIC,
    HYBRID,
    KINDS,
    NOTHING,
    RANDOM,
    WAYS,
)
from recalib.laboratory.report.doubts import doubts
from recalib.laboratory.report.templates import UNITS, render
from recalib.laboratory.results import Results
from recalib.spelling import counted

DOING = {
    NOTHING: "nothing",
    GEOMETRIC: "geometry, as in arm.urdf",
    HYBRID: "everything, as in correction.npz",
}
MOST = 12  # outliers, and unidentifiable directions, to list
BEYOND = 0.5  # deg, mm: limits in a URDF are rounded


class ErrorRow(NamedTuple):
    """Held-out errors [unit] for one way of folding rows and one correction."""

    folds: str
    what: str
    chosen: bool
    unit: str
    mean: float
    within: float  # radius that contains 95 % of the rows of every held-out part
    largest: float


def errors_table(result: Results) -> list[ErrorRow]:
    """Held-out errors of position and rotation, for each way of folding and each correction.

    The last rows show the outliers, which all other rows leave out.
    """
    validation, rows = result.validation, []

    def add(held_out: HeldOut, folds: str, what: str, chosen: bool) -> None:
        for number, (scale, unit) in enumerate(UNITS[: held_out.errors.shape[1]]):
            errors = held_out.errors[:, number]
            numbers = scale * np.array([errors.mean(), held_out.radius(number), errors.max()])
            rows.append(ErrorRow(folds, what, chosen, unit, *numbers.tolist()))

    for way in WAYS:
        for kind in KINDS:
            add(validation.held_out_by(way, kind), way, DOING[kind], kind == validation.chosen)
    if omitted := int(np.sum(~validation.counted)):
        outliers = validation.held_out[BLOCKWISE][validation.chosen][~validation.counted]
        add(outliers, "left out", f"{counted(omitted, 'row')}, as outliers", False)
    return rows


def verdict(result: Results) -> str:
    """The headline of a calibration, then its warnings."""
    chosen, omitted = result.validation.chosen, np.sum(~result.validation.counted)
    without = f", {omitted} of {len(result.data)} rows left out as outliers" if omitted else ""
    compared = (BLOCKWISE, NOTHING), (BLOCKWISE, chosen), (RANDOM, chosen)
    before, after, at_random = (1e3 * result.validation.mean_error(*one) for one in compared)
    if result.worthwhile:
        headline = (
            f"On postures away from those measured, the mean error falls from {before:.3g} mm to"
            f" {after:.3g} mm, 95 % within {1e3 * result.validation.radius:.3g} mm; near them, to"
            f" {at_random:.3g} mm{without}."
        )
    else:
        headline = (
            "The correction does not reduce the error: on held-out postures,"
            f" the nominal arm's mean error of {before:.3g} mm does not fall{without}."
        )
    return " ".join([headline, *doubts(result)])


def subject(result: Results) -> str:
    arm = result.arm
    name = result.urdf.origin if result.urdf else f"an arm of {len(arm.joints)} joints"
    return f"{name}, {arm.tool} in {arm.base}"


def summary(result: Results) -> str:
    texts = {"subject": subject(result), "verdict": verdict(result)}
    return render("summary.txt.j2", **texts, errors=errors_table(result), **_facts(result))


def notes(result: Results) -> list[str]:
    """Further facts about a calibration, one for each line."""
    return [subject(result), *render("notes.txt.j2", **_facts(result)).splitlines()]


def _facts(result: Results) -> dict[str, object]:
    """The values of the templates."""
    data, anywhere = result.data, []
    for one, words in (pair for pair in result.directions if pair[0].lasting):
        if result.geometry.model.free[one.parameter]:
            anywhere.append(words + "; try: describe [target]" * (len(data.tables) < 2))
        elif words.startswith("offset"):
            anywhere.append(words)
    corrected = "arm.urdf" if result.worthwhile else result.urdf.path.name if result.urdf else "arm"
    names = [path.name for path in data.tables]
    return {
        "result": result,
        "doing": DOING,
        "most": MOST,
        "files": names[0] if len(names) == 1 else names and f"{len(names)} folders",
        "fit": corrected,
        "cameras": [*_cameras(result)] if data.observations.optics is not None else [],
        "open_anywhere": anywhere,
        "joints": [*_joints(result)],
    }


def _cameras(result: Results) -> Iterator[tuple[str, float, float]]:
    """For each sight, mean corner errors [px] in held-out pictures: corrected, and nominal."""
    sights, held_out = result.data.observations.targets, result.validation.held_out[BLOCKWISE]
    for sight, name in enumerate(result.data.sight_names):
        rows = result.counted[sights[result.counted] == sight]
        kinds = result.validation.chosen, NOTHING
        error, nominal = (pixel_error(held_out[kind], rows) for kind in kinds)
        yield name, error, nominal


def pixel_error(held_out: HeldOut, rows: np.ndarray) -> float:
    """The mean over rows of the RMS corner error [px] in each held-out picture."""
    assert held_out.optics is not None
    return float(held_out.optics.moved(held_out.residuals)[rows].mean())


def _joints(result: Results) -> Iterator[dict[str, object]]:
    """The measured range of each joint, and its limits [unit]."""
    arm, still = result.arm, result.validation.postures.still
    limits = arm.model.lowerPositionLimit, arm.model.upperPositionLimit
    columns = arm.joints, arm.slides, still, result.data.observations.joints.T, *limits
    for name, slides, parked, joints, *allowed in zip(*columns, strict=True):
        scale, unit = UNITS[0] if slides else UNITS[1]
        low, high, lower, upper = (scale * end for end in (joints.min(), joints.max(), *allowed))
        beyond = low <= lower - BEYOND or high >= upper + BEYOND
        ends = {"low": low, "high": high, "lower": lower, "upper": upper}
        yield {"name": name, "unit": unit, "still": parked, "beyond": beyond, **ends}
