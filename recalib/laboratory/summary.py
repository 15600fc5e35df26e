"""What a person reads first: what the calibration is worth, what is known, what to doubt."""

from collections.abc import Iterator

import numpy as np

from recalib.identification.validation import GEOMETRIC, HYBRID, KINDS, NOTHING, RANDOM, WAYS
from recalib.laboratory.calibrate import Calibrated
from recalib.laboratory.doubts import doubts
from recalib.laboratory.parameters import open_directions
from recalib.meshes import with_own_meshes

DOING = {
    NOTHING: "nothing",
    GEOMETRIC: "geometry, as in arm.urdf",
    HYBRID: "all of it, as in correction.npz",
}
UNITS = (1e3, "mm"), (180 / np.pi, "deg")
MOST = 12  # doubted rows that are listed


def errors_table(result: Calibrated) -> list[dict]:
    """For each way of folding, quantity and what is done: mean, 95 % and largest error."""
    rows = []
    for way in WAYS:
        for kind in KINDS:
            errors = result.validation.errors(way, kind)[result.validation.counted]
            for (scale, unit), each in zip(UNITS, errors.T, strict=False):
                numbers = scale * np.array([each.mean(), np.quantile(each, 0.95), each.max()])
                rows.append(
                    {
                        "folds": way,
                        "what": DOING[kind],
                        "chosen": kind == result.validation.chosen,
                        "unit": unit,
                        **dict(zip(("mean", "95 %", "largest"), numbers.tolist(), strict=True)),
                    }
                )
    return rows


def summary(result: Calibrated) -> str:
    """A page of text."""
    return "\n".join(_lines(result)) + "\n"


def verdict(result: Calibrated) -> str:
    """In one sentence what it is worth, then what makes that doubtful."""
    return " ".join([_worth(result), *doubts(result)])


def _worth(result: Calibrated) -> str:
    before, after = (
        1e3 * result.validation.errors(RANDOM, kind)[result.validation.counted, 0].mean()
        for kind in (NOTHING, result.validation.chosen)
    )
    if not result.worthwhile:
        return (
            f"Correcting is no better than doing nothing: the {before:.3g} mm that the nominal arm"
            " misses on average do not become less on rows that were not learned from."
        )
    return (
        f"On rows that were not learned from, the mean error falls from {before:.3g} mm to"
        f" {after:.3g} mm."
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
        numbers = "".join(f"{row[name]:9.3f}" for name in ("mean", "95 %", "largest"))
        yield f"{row['folds']:<12}{what:<34}{numbers} {row['unit']}"
    yield "* used. Each row was predicted by a calibration that had not seen it; blocks of joint"
    yield "space tell of poses beside those that were measured."
    yield ""
    yield from _notes(result)


def _notes(result: Calibrated) -> Iterator[str]:
    arm, estimate = result.arm, result.calibration.estimate
    yield f"{len(result.seen)} rows of {result.table.name}"
    if result.beside is not None:
        yield f"nominal positions are those of the URDF, with {result.beside}"
    if arm.massless:
        yield "the URDF has no masses: what gravity does to the arm is not part of the model"
    _, unseen = with_own_meshes(result.source, result.urdf)
    if unseen:
        yield (
            f"{len(unseen)} meshes are in none of the URDF's packages and folders, and not in the"
            f" recording, as {unseen[0]}"
        )
    noise = (
        f"{scale * each:.3g} {unit}"
        for (scale, unit), each in zip(UNITS, estimate.noise, strict=False)
    )
    yield f"noise of a measurement along an axis, as estimated: {', '.join(noise)}"
    if result.sockets:
        yield "a ball in sockets shows errors there; between the sockets they may be larger"
    if result.validation.full[HYBRID].residual is not None:
        yield "chosen once, by all rows: how smooth the pattern in what is left is"
    if result.validation.unsettled:
        yield "more than geometry was found, and left out: its identification did not converge"
    if len(result.doubted):
        more = ", ..." if len(result.doubted) > MOST else ""
        listed = ", ".join(map(str, result.doubted[:MOST]))
        yield f"rows that do not fit the others and hardly counted: {listed}{more}"
    radius = 1e3 * np.median(result.validation.radii(result.seen.joints))
    covered = 100 * result.validation.coverage(RANDOM)
    yield f"95 % of positions should lie within {radius:.3g} mm (held out: {covered:.0f} %)"
    directions = open_directions(result)
    lasting = [words for words, other_postures_tell in directions if not other_postures_tell]
    for words in [words for words, other_postures_tell in directions if other_postures_tell][:MOST]:
        yield f"other postures would tell: {words}"
    for words in lasting:
        if words.startswith("offset"):
            yield f"no postures would tell: {words}"
    yield f"parameters that no such measurements tell apart, kept small: {len(lasting)}"
    for joint, slides, column in zip(arm.joints, arm.slides, result.seen.joints.T, strict=True):
        scale, unit = UNITS[0] if slides else UNITS[1]
        low, high = scale * column.min(), scale * column.max()
        yield f"{joint} was seen from {low:.1f} to {high:.1f} {unit}"
