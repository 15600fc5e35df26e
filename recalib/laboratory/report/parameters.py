"""The parameters of a calibrated arm by name, with what is known of each."""

from dataclasses import dataclass

import numpy as np

from recalib.identification.model.frames import HELD
from recalib.identification.parameters import Parameter, parameters_of
from recalib.laboratory.calibrate import Calibrated
from recalib.spelling import listed

HARDLY = 0.5  # of a prior deviation: what is known no better, the prior has decided


@dataclass(frozen=True)
class Decided(Parameter):
    """A parameter of geometry.

    Attributes:
        decided_by: data, or the prior where they do not determine it.
    """

    decided_by: str


def described(result: Calibrated) -> list[Decided]:
    """All parameters of geometry, in the order of the error model."""
    # not by a small deviation: the prior of what explains nothing becomes narrow
    by_prior = result.geometry.model.deviations <= HELD
    by_prior[[one.parameter for one in result.unidentifiable]] = True
    optics = result.geometry.model.optics_columns
    known = np.sqrt(np.diag(result.geometry.estimate.covariance)[optics])
    by_prior[optics] = known > HARDLY * result.geometry.model.deviations[optics]
    return [
        Decided(**vars(its), decided_by="prior" if prior else "data")
        for its, prior in zip(_parameters(result), by_prior, strict=True)
    ]


def unidentifiable_directions(result: Calibrated) -> list[tuple[str, bool]]:
    """Directions that are not identifiable, in words, and whether they are from other postures.

    Each is a parameter and those that would explain the same.
    """
    names = [its.name for its in _parameters(result)]
    alike = [
        (one, [names[n] for n in (one.parameter, *one.partners)]) for one in result.unidentifiable
    ]
    return [(listed(words, "or"), not one.lasting) for one, words in alike]


def _parameters(result: Calibrated) -> list[Parameter]:
    geometry, names = result.geometry, (result.targets, result.sockets, result.instruments)
    return parameters_of(geometry.model, geometry.estimate, *names)
