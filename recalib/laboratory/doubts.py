"""Warnings about a calibration as a whole, which are printed first."""

from collections.abc import Iterator

from recalib.identification.observations import Observations
from recalib.identification.sequence import DRIFT, JUMP, LAG, Fault
from recalib.identification.validation import BLOCKWISE, GEOMETRIC, HYBRID, RANDOM
from recalib.laboratory.calibrate import Calibrated

RESIZED = 0.015  # of a board: links are seldom longer or shorter by as much
CONTRADICTED = 2.0  # times the error of what is used: so far off is no part of it


def doubts(result: Calibrated) -> Iterator[str]:
    """Sentences, the gravest first; none where rows and lines agree."""
    for fault in result.faults:
        yield f"Careful: {_sentence(fault, result.observations)}."
    if abs(beside := result.board_scale - 1) > RESIZED:
        yield (
            f"Careful: if links are as long as the URDF has them, the board is"
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


def _sentence(fault: Fault, observations: Observations) -> str:
    size, rows = f"{1e3 * fault.size:.2g} mm", len(observations)
    late = abs(fault.size)
    lag = f"{100 * late:.2g} % of a step" if observations.times is None else f"{1e3 * late:.2g} ms"
    return {
        LAG: f"poses seem to be {lag} {'behind' if fault.size > 0 else 'ahead of'} the joints; try"
        " to measure at rest, or to synchronise both",
        DRIFT: f"the instrument seems to drift by {size} from the first row to the last; try a"
        " shorter session, or an instrument that is warm",
        JUMP: f"between rows {fault.row} and {fault.row + 1} instrument or base seem to have moved"
        f" by {size}; try rows 1 to {fault.row} and {fault.row + 1} to {rows} each by themselves",
    }[fault.kind]
