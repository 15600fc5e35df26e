"""The parameters of an error model, with names and readable units."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from recalib.identification.estimation import Identification
from recalib.identification.model.error_model import ErrorModel
from recalib.identification.model.optics import OPTICS

MOTIONS = "shift x", "shift y", "shift z", "turn x", "turn y", "turn z"


@dataclass(frozen=True)
class Parameter:
    """An estimated parameter and its uncertainty.

    Attributes:
        name: a phrase, such as offset of elbow_joint.
        unit: mm, deg or deg/Nm.
        value: the estimate, in that unit.
        deviation: its standard error, in that unit, from data and prior together: it may be small
            although the data do not identify the parameter, if the prior is narrow.
    """

    name: str
    unit: str
    value: float
    deviation: float


def parameters_of(
    model: ErrorModel,
    estimate: Identification,
    targets: Sequence[str] = (),
    sockets: Sequence[str] = (),
    instruments: Sequence[str] = (),
) -> list[Parameter]:
    """All parameters, in the order of the model; objects without a name appear by number."""
    errors = np.sqrt(np.diag(estimate.covariance))
    return [
        Parameter(name, unit, float(scale * value), float(scale * error))
        for (name, unit, scale), value, error in zip(
            _names(model, targets, sockets, instruments), estimate.parameters, errors, strict=True
        )
    ]


def _names(
    model: ErrorModel, targets: Sequence[str], sockets: Sequence[str], instruments: Sequence[str]
) -> Iterator[tuple[str, str, float]]:
    """The name and unit of each parameter, and the number of these units in an SI unit."""
    arm, frames = model.nominal, model.frames
    links = ["of base", *(f"behind {joint}" for joint in arm.joints[:-1])]
    ends = [f"of target {name}" for name in targets or range(len(frames.targets))]
    if len(ends) == 1:
        ends = ["of target" if frames.targets_unknown else "of tool"]
    bases = [f"of base to {name}" for name in instruments or range(len(frames.bases))]
    for where in [*links, *ends, *bases[1:]]:
        for motion in MOTIONS:
            yield f"{motion} {where}", *_unit(slides=motion.startswith("shift"))
    for socket in sockets or range(len(frames.sockets)):
        for axis in "xyz":
            yield f"{axis} of socket {socket}, from its initial estimate", "mm", 1e3
    kinds = frames.optics_kinds.tolist()
    for column, kind in enumerate(kinds):
        name, unit, size, _ = OPTICS[kind]
        several = f", {kinds[:column].count(kind) + 1}" if kinds.count(kind) > 1 else ""
        yield f"{name}{several}", unit, 1 / size
    for term in model.names:
        for joint, slides in zip(arm.joints, arm.slides, strict=True):
            unit, scale = _unit(slides)
            yield f"{term} of {joint}", f"{unit}/Nm" if term == "compliance" else unit, scale


def _unit(slides: bool) -> tuple[str, float]:
    return ("mm", 1e3) if slides else ("deg", 180 / np.pi)
