"""The parameters of a calibrated arm by name, with what is known of each."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from recalib.identification.frames import HELD
from recalib.laboratory.calibrate import Calibrated
from recalib.spelling import listed

MOTIONS = "shift x", "shift y", "shift z", "turn x", "turn y", "turn z"


@dataclass(frozen=True)
class Parameter:
    """One of them.

    Attributes:
        name: in words.
        unit: mm or deg, or what else a joint's error is a function of.
        value, deviation: in that unit, of the estimate.
        decided_by: data, or prior where these do not tell it from others.
    """

    name: str
    unit: str
    value: float
    deviation: float
    decided_by: str


def described(result: Calibrated) -> list[Parameter]:
    """All parameters of geometry, in the order of the error model."""
    calibration = result.geometry
    # a small deviation tells nothing: of what explains nothing, the prior becomes narrow
    estimate, by_prior = calibration.estimate, calibration.model.deviations <= HELD
    by_prior[[one.parameter for one in result.unidentifiable]] = True
    deviations = np.sqrt(np.diag(estimate.covariance))
    return [
        Parameter(
            name,
            unit,
            float(scale * estimate.parameters[index]),
            float(scale * deviations[index]),
            "prior" if by_prior[index] else "data",
        )
        for index, (name, unit, scale) in enumerate(_names(result))
    ]


def unidentifiable_directions(result: Calibrated) -> list[tuple[str, bool]]:
    """What measurements leave open, in words, and whether any other postures could tell it.

    Each is a parameter and those that would explain the same.
    """
    names = [name for name, *_ in _names(result)]
    alike = [
        (one, [names[n] for n in (one.parameter, *one.partners)]) for one in result.unidentifiable
    ]
    return [(listed(words, "or"), not one.lasting) for one, words in alike]


def _names(result: Calibrated) -> Iterator[tuple[str, str, float]]:
    """Name, unit, and its number in an SI unit, of each parameter of geometry."""
    arm, frames = result.arm, result.geometry.model.frames
    links = ["of base", *(f"behind {joint}" for joint in arm.joints[:-1])]
    ends = [f"of target {name}" for name in result.targets]
    if len(ends) == 1:
        ends = ["of target" if frames.targets_unknown else "of tool"]
    for where in [*links, *ends]:
        for motion in MOTIONS:
            unit, scale = _unit(slides=motion.startswith("shift"))
            yield f"{motion} {where}", unit, scale
    for socket in result.sockets:
        for axis in "xyz":
            yield f"{axis} of socket {socket}, beside its first guess", "mm", 1e3
    for joint, slides in zip(arm.joints, arm.slides, strict=True):
        yield f"offset of {joint}", *_unit(slides)


def _unit(slides: bool) -> tuple[str, float]:
    return ("mm", 1e3) if slides else ("deg", 180 / np.pi)
