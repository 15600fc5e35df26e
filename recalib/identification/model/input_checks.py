"""Checks of observations before an identification: uninformative ones are refused."""

import numpy as np

from recalib.errors import BadMeasurement
from recalib.identification.model.error_model import ErrorModel
from recalib.identification.model.observations import Observations
from recalib.loop.external import FARTHEST, POSE, are_poses

TURNED = 4 * np.pi  # rad either way: beyond what joints do, or not in radians


def check_observations(observations: Observations, model: ErrorModel) -> None:
    """Raise BadMeasurement unless the parameters of a model can be identified from these."""
    count, slides = len(observations), model.nominal.slides
    if count == 0:
        raise BadMeasurement("the number of observations", [0], "one or more")
    sizes: dict[str, list[tuple[int, ...]]] = {
        "joints": [(count, len(slides))],
        "targets": [(count,)],
    }
    if observations.measured is None:
        sizes["sockets"] = [(count,)]
    else:
        sizes["measured"] = [(count, 3), (count, 4, 4)]
    for name, fit in sizes.items():
        size = np.shape(getattr(observations, name))
        if size not in fit:
            valid = " or ".join(map(str, fit))
            raise BadMeasurement(f"the size of the observations' {name!r}", size, valid)
    tables = [
        ("joint angles of measurement", observations.joints[:, ~slides], TURNED, "rad"),
        ("joint positions of measurement", observations.joints[:, slides], FARTHEST, "m"),
    ]
    if observations.measured is not None:
        tables.append(("measurement", observations.measured, FARTHEST, "m in the base frame"))
    for what, values, most, unit in tables:
        valid = f"numbers up to {most:.3g} ({unit})"
        _check_each(what, values, np.abs(values) <= most, valid)
    check_rows(observations)
    for what, numbers, end in (
        ("target of measurement", observations.targets, len(model.frames.sights)),
        ("socket of measurement", observations.sockets, len(model.frames.sockets)),
    ):
        if numbers is not None:
            _check_each(what, numbers, np.isin(numbers, np.arange(end)), f"below {end}")


def check_rows(observations: Observations) -> None:
    """Raise BadMeasurement unless all rows are numbers, and all measured matrices are poses."""
    joints, measured = observations.joints, observations.measured
    _check_each("joint angles of measurement", joints, np.isfinite(joints), "numbers")
    if measured is not None:
        _check_each("measurement", measured, np.isfinite(measured), "numbers")
        if observations.kinds == 2:
            _check_each("measurement", measured, are_poses(measured), POSE)


def _check_each(what: str, values: np.ndarray, good: np.ndarray, valid: str) -> None:
    """Raise BadMeasurement for the first row (n, ...) of which not all is good."""
    rows = good.reshape(len(good), -1).all(axis=1)
    if not rows.all():
        row = rows.argmin()
        raise BadMeasurement(f"{what} {row}", np.ravel(values[row]), valid)
