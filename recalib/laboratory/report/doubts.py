"""Warnings about a whole calibration, which are printed first."""

from collections.abc import Iterator

import numpy as np

from recalib.identification.checks.gains import WrongGain
from recalib.identification.checks.postures import turned_axes
from recalib.identification.checks.sequence import Fault
from recalib.identification.model.frames import HELD, Frames
from recalib.identification.parameters import Parameter
from recalib.identification.validation import BLOCKWISE, GEOMETRIC, HYBRID, RANDOM
from recalib.laboratory.data_set import DataSet
from recalib.laboratory.report.templates import render
from recalib.laboratory.results import Results
from recalib.nominal.kinematics import Arm

RESIZED = 0.015  # of a size: all links together are seldom longer by more
TOGETHER = 0.3  # of the residuals: less remains if one factor for all links explains them
OUTVOTED = 0.5  # of the rows of a sight: if more are outliers, the other sights contradict it
WORN = 3.0  # prior deviations: wear explains no larger error
ENDS, NAMED = ("of base", "of tool", "of target"), 3  # names listed first, and how many at most
CONTRADICTED = 2.0  # times the error at random: larger errors contradict it
MOST = 6  # rows to list


def doubts(result: Results) -> list[str]:
    """Warnings, the gravest first."""
    ends = [words for one, words in result.directions if not one.lasting]
    gain = None if result.mistake else result.wrong_gain
    joints = result.data.observations.joints
    lines = render(
        "doubts.txt.j2",
        result=result,
        faults=[fault_in_words(fault, result.data, result.frames) for fault in result.faults],
        gain=gain and gain_in_words(gain, result.arm),
        outvoted=[*_outvoted(result)],
        worn=_worn(result),
        axes=turned_axes(result.arm.forward(joints)) if result.unseen else (),
        open_here=sorted(ends, key=lambda words: not any(end in words for end in ENDS)),
        resized=[*_resized(result)],
        contradicted=_contradicted(result),
        most=MOST,
        named=NAMED,
    )
    return [f"Careful: {line}." for line in lines.splitlines()]


def fault_in_words(fault: Fault, data: DataSet, frames: Frames) -> str:
    """What seems to have happened, where, and what to try, without a full stop."""
    sight, observations, in_sockets = fault.sight, data.observations, bool(len(frames.sockets))
    instrument, target = frames.sights[sight]
    series = observations.series
    return render(
        "fault.txt.j2",
        fault=fault,
        folder=data.tables[sight].parent if len(data.tables) > 1 else None,
        stands="the sockets" if in_sockets else data.instruments[instrument],
        moves="the ball" if in_sockets else data.target_names[target],
        sockets=in_sockets,
        timed=observations.times is not None,
        rows=np.count_nonzero(series == series[observations.targets == sight][0]),
    )


def gain_in_words(wrong: WrongGain, arm: Arm) -> str:
    """A joint that moves more or less than its column says, without a full stop."""
    return render("gain.txt.j2", wrong=wrong, joints=arm.joints).strip()


def _outvoted(result: Results) -> Iterator[tuple[str, int, int]]:
    """Cameras that the others contradict: name, number of outlying pictures, number of all."""
    series, names = result.data.observations.series, result.data.sight_names
    for number, name in enumerate(names if len(result.data.tables) > 1 else []):
        outliers = np.count_nonzero(series[result.doubted - 1] == number)
        if outliers > OUTVOTED * (rows := np.count_nonzero(series == number)):
            yield name, int(outliers), int(rows)


def _worn(result: Results) -> tuple[Parameter, float] | None:
    """The joint or link error that exceeds its prior deviation most, and the ratio, if > `WORN`."""
    model = result.geometry.model
    ratios = result.geometry.estimate.parameters / model.deviations
    ratios = np.where(model.free | (model.deviations <= HELD), 0.0, np.abs(ratios))
    ratios[model.optics_columns] = 0.0
    largest = int(ratios.argmax())
    return (result.parameters[largest], ratios[largest]) if ratios[largest] > WORN else None


def _resized(result: Results) -> Iterator[tuple[str, float, bool]]:
    """Sizes that differ from the description, if the URDF's links are right: percent, and sign.

    Printers often change the scale, instruments seldom.
    """
    most = TOGETHER if result.data.observations.optics is None else np.inf
    for what, (factor, remaining) in result.scales.items():
        if abs(factor - 1) > RESIZED and remaining < most:
            yield what, 100 * abs(factor - 1), factor > 1


def _contradicted(result: Results) -> tuple[float, float, float] | None:
    """Errors at random, in blocks and of geometry [mm] if the last two contradict the first."""
    if result.validation.chosen != HYBRID:
        return None
    compared = (RANDOM, HYBRID), (BLOCKWISE, HYBRID), (RANDOM, GEOMETRIC)
    whole, away, geometry = (1e3 * result.validation.mean_error(*one) for one in compared)
    return (whole, away, geometry) if min(away, geometry) > CONTRADICTED * whole else None
