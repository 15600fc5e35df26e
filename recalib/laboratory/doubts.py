"""Warnings about a calibration as a whole, which are printed first."""

from collections.abc import Iterator

import numpy as np

from recalib.identification.sequence import DRIFT, JUMP, LAG, SLIP, Fault
from recalib.identification.validation import BLOCKWISE, GEOMETRIC, HYBRID, RANDOM
from recalib.laboratory.calibrate import Calibrated

RESIZED = 0.015  # of a board: links are seldom longer or shorter by as much
OUTVOTED = 0.5  # of the rows of a sight: were more outliers, something of it is not as described
CONTRADICTED = 2.0  # times the error of what is used: so far off is no part of it


def doubts(result: Calibrated) -> Iterator[str]:
    """Sentences, the gravest first; none where rows and lines agree."""
    for fault in result.faults:
        yield f"Careful: {_sentence(fault, result)}."
    yield from _outvoted(result)
    for board, scale in result.board_scales.items():
        if abs(beside := scale - 1) > RESIZED:
            yield (
                f"Careful: if links are as long as the URDF has them, {board} is"
                f" {100 * abs(beside):.1f} percent {'larger' if beside > 0 else 'smaller'} than its"
                " description; measure its squares."
            )
    validation = result.validation
    if validation.chosen != HYBRID:
        return
    compared = (RANDOM, HYBRID), (BLOCKWISE, HYBRID), (RANDOM, GEOMETRIC)
    whole, away, geometry = (1e3 * validation.mean_error(*one) for one in compared)
    if min(away, geometry) > CONTRADICTED * whole:
        yield (
            f"Careful: expect {away:.3g} mm on other postures, not {whole:.3g} mm. Geometry alone"
            f" leaves {geometry:.3g} mm, so most of the gain is a pattern of these rows only."
        )


def _outvoted(result: Calibrated) -> Iterator[str]:
    """Of several cameras, those whose pictures the others contradict."""
    series = result.observations.series
    for number, name in enumerate(result.sights if len(result.tables) > 1 else []):
        doubted = np.count_nonzero(series[result.doubted - 1] == number)
        if doubted > OUTVOTED * (rows := np.count_nonzero(series == number)):
            yield (
                f"Careful: {doubted} of {rows} pictures of {name} contradict the others; are camera"
                " and board where the others have them, and the joints those of the pictures?"
            )


def _sentence(fault: Fault, result: Calibrated) -> str:
    observations, sight = result.observations, fault.sight
    where = f"in {result.tables[sight].parent}, " if len(result.tables) > 1 else ""
    instrument, target = result.frames.sights[sight]
    stands, moves = result.instruments[instrument], result.ends[target]
    series = observations.series
    rows = np.count_nonzero(series == series[observations.targets == sight][0])
    size, late = f"{1e3 * fault.size:.2g} mm", abs(fault.size)
    moved = f"{size} and {np.degrees(fault.turn):.2g} deg"
    between = f"between rows {fault.row} and {fault.row + 1}"
    parts = f"try rows 1 to {fault.row} and {fault.row + 1} to {rows} each by themselves"
    if not fault.row:
        between, parts = "before row 1", "try each folder by itself"
    lag = f"{100 * late:.2g} % of a step" if observations.times is None else f"{1e3 * late:.2g} ms"
    sentences = {
        LAG: f"poses seem to be {lag} {'behind' if fault.size > 0 else 'ahead of'} the joints; try"
        " to measure at rest, or to synchronise both",
        DRIFT: f"{stands} seems to drift by {size} from the first row to the last; try a"
        " shorter session, or an instrument that is warm",
        JUMP: f"{between} {stands.removeprefix('the ')} or base seem to have moved by {moved};"
        f" {parts}",
        SLIP: f"{between} {moves} seems to have slipped on the tool by {moved}; {parts}",
    }
    return where + sentences[fault.kind]
