"""Checks of observations before an identification: uninformative ones are refused."""

import numpy as np

from recalib.errors import BadMeasurement
from recalib.identification.model.error_model import ErrorModel
from recalib.identification.model.observations import Observations
from recalib.loop.external import FARTHEST, POSE, are_poses

TURNED = 4 * np.pi  # rad either way: beyond what joints do, or not in radians


def check_observations(observations: Observations, model: ErrorModel) -> None:
    """Raise BadMeasurement unless the parameters of a model can be identified from these."""
    count, joints = len(observations), len(model.nominal.slides)
    if count == 0:
        raise BadMeasurement("the number of observations", [0], "one or more")
    sizes: dict[str, list[tuple[int, ...]]] = {
        "joints": [(count, joints)],
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
    slides = model.nominal.slides
    tables = [
        ("joint angles of measurement", observations.joints[:, ~slides], TURNED, "rad"),
        ("joint positions of measurement", observations.joints[:, slides], FARTHEST, "m"),
    ]
    if observations.measured is not None:
        tables.append(("measurement", observations.measured, FARTHEST, "m in the base frame"))
    for what, values, most, unit in tables:
        wrong = ~(np.abs(values) <= most).reshape(count, -1).all(axis=1)
        if wrong.any():
            row = wrong.argmax()
            valid = f"numbers up to {most:.3g} ({unit})"
            raise BadMeasurement(f"{what} {row}", np.ravel(values[row]), valid)
    check_rows(observations)
    for what, numbers, most in (
        ("target", observations.targets, len(model.frames.sights)),
        ("socket", observations.sockets, len(model.frames.sockets)),
    ):
        if numbers is not None and not (np.isin(numbers, np.arange(most))).all():
            row = (~np.isin(numbers, np.arange(most))).argmax()
            raise BadMeasurement(f"{what} of measurement {row}", [numbers[row]], f"below {most}")


def check_rows(observations: Observations) -> None:
    """Raise BadMeasurement unless all rows are numbers, and all measured matrices are poses."""
    joints, measured = observations.joints, observations.measured
    tables = [("joint angles of measurement", joints, np.isfinite(joints).all(axis=1), "numbers")]
    if measured is not None:
        finite = np.isfinite(measured).reshape(len(measured), -1).all(axis=1)
        tables.append(("measurement", measured, finite, "numbers"))
        if observations.kinds == 2:
            tables.append(("measurement", measured, are_poses(measured), POSE))
    for what, values, fit, valid in tables:
        if not fit.all():
            row = fit.argmin()
            raise BadMeasurement(f"{what} {row}", np.ravel(values[row]), valid)
