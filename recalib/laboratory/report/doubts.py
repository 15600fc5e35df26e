"""Warnings about a calibration as a whole, which are printed first."""

from collections.abc import Iterator

import numpy as np

from recalib.identification.checks.postures import turned_axes
from recalib.identification.model.frames import HELD
from recalib.identification.validation import BLOCKWISE, GEOMETRIC, HYBRID, RANDOM
from recalib.laboratory.plausibility.fault_words import (
    displaced_in_words,
    exchanged_in_words,
    gain_in_words,
    in_words,
)
from recalib.laboratory.report.identified import named_parameters, unidentifiable_directions
from recalib.laboratory.results import Results
from recalib.spelling import counted

RESIZED = 0.015  # of a size: all links together are seldom so much longer
TOGETHER = 0.3  # the part of residuals that remains if one factor for all links explains them
OUTVOTED = 0.5  # of the rows of a sight: if more are outliers, it is not as described
WORN = 3.0  # deviations of what wear is expected to do: beyond that is something else
ENDS, MOST = ("of base", "of tool", "of target"), 3  # what is named first, and how much is named
CONTRADICTED = 2.0  # times the error at random: more in both others is a contradiction


def doubts(result: Results) -> Iterator[str]:
    """Warnings, the gravest first."""
    if result.mistake:
        yield (
            "Careful: the table probably contains a mistake, without which the URDF fits far"
            f" better: {result.mistake}."
        )
    for doubt in result.data.cameras.doubts if result.data.cameras else ():
        yield f"Careful: {doubt}."
    for fault in result.faults:
        yield f"Careful: {in_words(fault, result.data, result.frames)}."
    for run in result.displaced:
        yield f"Careful: {displaced_in_words(run)}."
    if result.exchanged:
        yield f"Careful: {exchanged_in_words(result.exchanged)}."
    if result.wrong_gain and not result.mistake:
        yield f"Careful: {gain_in_words(result.wrong_gain, result.arm.joints)}."
    yield from _outvoted(result)
    if not result.mistake:
        yield from _worn(result)
    yield from _open(result)
    yield from _resized(result)
    validation = result.validation
    if validation.chosen != HYBRID:
        return
    compared = (RANDOM, HYBRID), (BLOCKWISE, HYBRID), (RANDOM, GEOMETRIC)
    whole, away, geometry = (1e3 * validation.mean_error(*one) for one in compared)
    if min(away, geometry) > CONTRADICTED * whole:
        yield (
            f"Careful: expect {away:.3g} mm away from the measured postures, not {whole:.3g} mm."
            f" The error of geometry alone is {geometry:.3g} mm, so most of the improvement is"
            " specific to these rows."
        )


def _worn(result: Results) -> Iterator[str]:
    """The offset or error of a link that is too large for one, if there is one."""
    model = result.geometry.model
    ratios = result.geometry.estimate.parameters / model.deviations
    ratios = np.where(model.free | (model.deviations <= HELD), 0.0, np.abs(ratios))
    ratios[model.optics_columns] = 0.0
    if ratios.max() > WORN:
        largest = named_parameters(result)[int(ratios.argmax())]
        yield (
            f"Careful: the {largest.name} would be {largest.value:.3g} {largest.unit}; expected"
            f" from wear: {1 / ratios.max() * abs(largest.value):.2g} {largest.unit}. Check that"
            " each column belongs to its joint and has the URDF's zero."
        )


def _open(result: Results) -> Iterator[str]:
    """What postures leave open that others would tell."""
    if not result.unseen:
        return
    pairs = zip(result.unidentifiable, unidentifiable_directions(result), strict=True)
    words = [words for one, words in pairs if not one.lasting]
    words.sort(key=lambda text: not any(end in text for end in ENDS))
    axes = turned_axes(result.arm.forward(result.data.observations.joints))
    turns = ["never turned", "turned about only one axis", "turned about only two axes"]
    about = " and ".join(f"({', '.join(f'{x + 0.0:.2g}' for x in axis.round(2))})" for axis in axes)
    where = f", {about} of {result.arm.base}" * (0 < len(axes) < 3)
    tool = f"{result.arm.tool} {turns[len(axes)]}{where}" if len(axes) < 3 else "postures are alike"
    rest = len(words) - MOST
    more = f"; and {counted(rest, 'further direction')}" if rest > 0 else ""
    named = f" Not identifiable, and kept nominal: {'; '.join(words[:MOST])}{more}."
    only = f"Careful: {tool}, so these results hold only for such postures."
    yield only + named * bool(words)


def _resized(result: Results) -> Iterator[str]:
    """What has another size than described, if links are as long as in the URDF."""
    optics, measured = result.data.observations.optics, result.data.observations.measured
    most = TOGETHER if optics is None else np.inf  # printers scale often, instruments seldom
    for what, (factor, remaining) in result.scales.items():
        if abs(factor - 1) <= RESIZED or remaining >= most:
            continue
        percent, large = f"{100 * abs(factor - 1):.1f} percent", factor > 1
        if optics is None and measured is not None:
            off = f"{what} in the table are {percent} too {'small' if large else 'large'}"
            advice = "check their unit, and the instrument's scale"
        else:
            off = f"{what} is {percent} {'larger' if large else 'smaller'} than its description"
            advice = "measure it again" if optics is None else "measure its squares"
        yield f"Careful: if the URDF's link lengths are right, {off}; {advice}."


def _outvoted(result: Results) -> Iterator[str]:
    """Cameras whose pictures the others contradict."""
    series, names = result.data.observations.series, result.data.sight_names
    for number, name in enumerate(names if len(result.data.tables) > 1 else []):
        doubted = np.count_nonzero(series[result.doubted - 1] == number)
        if doubted > OUTVOTED * (rows := np.count_nonzero(series == number)):
            yield (
                f"Careful: {doubted} of {rows} pictures of {name} contradict the others; check the"
                " places of camera and board, and the joints of these pictures."
            )
