"""The identified parameters by name, with their uncertainties."""

from typing import Any

import numpy as np

from recalib.identification.model.frames import HELD
from recalib.identification.parameters import Parameter, parameters_of
from recalib.laboratory.results import Results
from recalib.spelling import listed

HARDLY = 0.5  # of a prior deviation: data that reduce it by less have not decided


def identified_parameters(result: Results) -> list[dict[str, Any]]:
    """All parameters of geometry: name, unit, value, deviation, and `decided_by` data or prior."""
    # not by a small deviation: the prior of what explains nothing becomes narrow
    by_prior = result.geometry.model.deviations <= HELD
    by_prior[[one.parameter for one in result.unidentifiable]] = True
    optics = result.geometry.model.optics_columns
    known = np.sqrt(np.diag(result.geometry.estimate.covariance)[optics])
    by_prior[optics] = known > HARDLY * result.geometry.model.deviations[optics]
    return [
        vars(parameter) | {"decided_by": "prior" if prior else "data"}
        for parameter, prior in zip(named_parameters(result), by_prior, strict=True)
    ]


def unidentifiable_directions(result: Results) -> list[str]:
    """For each of `Results.unidentifiable`, the parameter and its partners in words."""
    names = [parameter.name for parameter in named_parameters(result)]
    return [
        listed((names[number] for number in (one.parameter, *one.partners)), "or")
        for one in result.unidentifiable
    ]


def named_parameters(result: Results) -> list[Parameter]:
    """All parameters of geometry, in the order of the error model."""
    geometry, data = result.geometry, result.data
    names = data.targets, data.sockets, data.instruments
    return parameters_of(geometry.model, geometry.estimate, *names)
