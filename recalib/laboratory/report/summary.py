"""The printed summary of a calibration: its errors, what is known of the arm, doubts."""

from collections.abc import Iterator, Sequence
from typing import Any

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
from recalib.laboratory.arms.urdf import angles_of
from recalib.laboratory.calibrate import Calibrated, rows_of
from recalib.laboratory.report.doubts import doubts
from recalib.laboratory.report.hand_eye import pixel_error
from recalib.laboratory.report.parameters import unidentifiable_directions
from recalib.nominal.meshes import with_own_meshes
from recalib.spelling import counted

DOING = {
    NOTHING: "nothing",
    GEOMETRIC: "geometry, as in arm.urdf",
    HYBRID: "all of it, as in correction.npz",
}
UNITS = (1e3, "mm"), (180 / np.pi, "deg")
NUMBERS = "mean", "95 %", "largest"  # of errors
MOST = 12  # doubted rows that are listed
BEYOND = 0.5  # deg, mm: limits are rounded


def errors_table(result: Calibrated) -> list[dict[str, Any]]:
    """For each way of folding, quantity and what is done: mean, 95 % and largest error.

    The last rows are of what is used on outliers, which all others leave out.
    """
    validation, rows = result.validation, []

    def add(held_out: HeldOut, folds: str, what: str, chosen: bool) -> None:
        for number, (scale, unit) in enumerate(UNITS[: held_out.errors.shape[1]]):
            errors = held_out.errors[:, number]
            numbers = scale * np.array([errors.mean(), held_out.radius(number), errors.max()])
            row = {"folds": folds, "what": what, "chosen": chosen, "unit": unit}
            rows.append(row | dict(zip(NUMBERS, numbers.tolist(), strict=True)))

    for way in WAYS:
        for kind in KINDS:
            add(validation.held_out_by(way, kind), way, DOING[kind], kind == validation.chosen)
    if left := int(np.sum(~validation.counted)):
        outliers = validation.held_out[BLOCKWISE][validation.chosen][~validation.counted]
        add(outliers, "left out", f"{counted(left, 'row')}, as outliers", False)
    return rows


def summary(result: Calibrated) -> str:
    """A page of text."""
    return "\n".join(_lines(result)) + "\n"


def verdict(result: Calibrated) -> str:
    """In one sentence what it is worth, then what makes that doubtful."""
    return " ".join([_worth(result), *doubts(result)])


def _worth(result: Calibrated) -> str:
    chosen, left = result.validation.chosen, np.sum(~result.validation.counted)
    without = f", {left} of {len(result.observations)} rows left out as outliers" if left else ""
    compared = (BLOCKWISE, NOTHING), (BLOCKWISE, chosen), (RANDOM, chosen)
    before, after, at_random = (1e3 * result.validation.mean_error(*one) for one in compared)
    within = 1e3 * result.validation.radius
    if not result.worthwhile:
        return (
            "Correcting is no better than doing nothing: on postures that were not learned from,"
            f" the nominal arm's mean error of {before:.3g} mm does not fall{without}."
        )
    return (
        f"On postures away from those measured, the mean error falls from {before:.3g} mm to"
        f" {after:.3g} mm, 95 % within {within:.3g} mm; near them, to {at_random:.3g} mm{without}."
    )


def notes(result: Calibrated) -> list[str]:
    """What else to know of it, in a line each."""
    return [_subject(result), *_notes(result)]


def _subject(result: Calibrated) -> str:
    return f"{result.origin}, {result.arm.tool} in {result.arm.base}"


def _lines(result: Calibrated) -> Iterator[str]:
    yield _subject(result)
    yield verdict(result)
    yield ""
    yield f"{'folds':<12}{'what is corrected':<34}{'mean':>9}{'95 %':>9}{'largest':>9}"
    for row in errors_table(result):
        what = row["what"] + (" *" if row["chosen"] else "")
        numbers = "".join(f"{row[name]:9.3f}" for name in NUMBERS)
        yield f"{row['folds']:<12}{what:<34}{numbers} {row['unit']}"
    yield "* used. Each row was predicted by a calibration without it: at random among postures"
    yield "like it, or in blocks of joint space, away from all postures that were measured."
    yield "95 %: within it lie 95 % of the rows of each part that was held out."
    yield ""
    yield from _notes(result)


def _notes(result: Calibrated) -> Iterator[str]:
    arm, estimate = result.arm, result.calibration.estimate
    postures = result.validation.postures
    tables = result.tables
    files = tables[0].name if len(tables) == 1 else f"{len(tables)} folders"
    rows = f"{len(result.observations)} rows of {files}"
    yield rows if len(postures) == len(result.observations) else f"{len(postures)} postures, {rows}"
    if len(tables) > 1:
        yield from rows_of(result.observations, result.sights)
    if result.between is not None:
        yield f"nominal positions are those of the URDF, with {result.between}"
    if arm.massless:
        yield "the URDF has no masses: what gravity does to the arm is not part of the model"
    _, unseen = with_own_meshes(result.source, result.urdf)
    if unseen:
        yield (
            f"missing from the recording: {counted(len(unseen), 'mesh file')} in none of the URDF's"
            f" packages and folders, as {unseen[0]}"
        )
    used, noise = DOING[result.validation.chosen], _in_units(estimate.noise, 3)
    yield f"noise of a measurement along an axis: {noise} (what is corrected: {used})"
    yield from _places(result)
    if result.observations.optics is not None:
        kinds = result.validation.chosen, NOTHING
        for number, name in enumerate(result.sights):
            of = f" of {name}" if len(result.tables) > 1 else ""
            found, right = (pixel_error(result, BLOCKWISE, kind, number) for kind in kinds)
            yield (
                f"corners in pictures{of} that were not learned from: {found:.2g} px off; with the"
                f" arm as it is described, {right:.2g} px"
            )
        own = 1e3 * result.observations.optics.length
        yield f"a picture alone tells a position to {own:.2g} mm: part of each held-out error"
    if result.sockets:
        yield "a ball in sockets shows errors there; between the sockets they may be larger"
    if result.validation.full[HYBRID].pattern is not None:
        yield "length scales of the Gaussian process come from all rows, also those held out"
    if result.validation.unsettled:
        yield "errors beyond geometry are not corrected: their identification did not converge"
    if len(result.doubted):
        more = ", ..." if len(result.doubted) > MOST else ""
        listed = ", ".join(map(str, result.doubted[:MOST]))
        yield f"outliers, rows with almost no weight: {listed}{more}"
    covered = 100 * result.validation.coverage(BLOCKWISE)
    yield (
        f"95 % within {1e3 * result.validation.radius:.3g} mm, also away from what was measured; so"
        f" made from the other parts, it holds for {covered:.0f} % of the rows held out"
    )
    for way in WAYS:
        if lost := int(np.sum(result.validation.lost[way])):
            yield (
                f"errors {way} leave out {counted(lost, 'row')}: without their part, the others do"
                " not determine all that all rows do"
            )
    directions = unidentifiable_directions(result)
    passing = [words for words, other_postures_tell in directions if other_postures_tell]
    for words in passing[:MOST]:
        yield f"identifiable from other postures: {words}"
    lasting = [one for one in zip(result.unidentifiable, directions, strict=True) if one[0].lasting]
    for one, (words, _) in lasting:
        if result.geometry.model.free[one.parameter]:  # instrument and target make up for it
            advice = "; try: describe [target]" if len(result.tables) == 1 else ""
            yield f"not identifiable from any posture: {words}{advice}"
        elif words.startswith("offset"):
            yield f"not identifiable from any posture: {words}"
    yield f"parameters not identifiable from such measurements, kept small: {len(lasting)}"
    limits = arm.model.lowerPositionLimit, arm.model.upperPositionLimit
    columns = arm.joints, arm.slides, postures.still, result.observations.joints.T, *limits
    for joint, slides, still, column, *allowed in zip(*columns, strict=True):
        scale, unit = UNITS[0] if slides else UNITS[1]
        low, high = scale * column.min(), scale * column.max()
        if still:
            yield f"{joint} stood still at {low:.1f} {unit}: nothing is known of its own errors"
            continue
        lower, upper = (scale * limit for limit in allowed)
        within = lower - BEYOND < low and high < upper + BEYOND
        outside = f", beyond its limits in the URDF, {lower:.1f} to {upper:.1f}"
        measured = f"{joint} was measured from {low:.1f} to {high:.1f} {unit}"
        yield measured if within else measured + outside


def _places(result: Calibrated) -> Iterator[str]:
    """Where instrument, targets and sockets are."""
    fit = "arm.urdf" if result.worthwhile else result.urdf.name
    for place in result.places:
        where = ", ".join(f"{1e3 * number:.2f}" for number in place.pose[:3, 3])
        words, kinds = f"{place.name} in {place.link} of {fit}: ({where}) mm", 1
        if place.turned:
            turns = ", ".join(f"{angle:.3f}" for angle in np.degrees(angles_of(place.pose)))
            words, kinds = f"{words}, roll, pitch and yaw ({turns}) deg", 2
        known, real = (
            _in_units(its[:kinds], 2) for its in (place.deviations, place.real_deviations)
        )
        yield f"{words}, deviation {known}; relative to the real {place.link}, {real}"


def _in_units(numbers: Sequence[float] | np.ndarray, digits: int) -> str:
    """A length [m] and, if there is one, an angle [rad] as people read them."""
    pairs = zip(UNITS, numbers, strict=False)
    return ", ".join(f"{scale * number:.{digits}g} {unit}" for (scale, unit), number in pairs)
