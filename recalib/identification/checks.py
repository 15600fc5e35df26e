"""Observations as they enter the identification: what tells nothing of an arm is refused."""

import numpy as np

from recalib.errors import BadMeasurement
from recalib.identification.error_model import ErrorModel
from recalib.identification.observations import Observations
from recalib.measurements import FARTHEST

TURNED = 4 * np.pi  # rad either way: beyond what joints do, or not in radians


def check_observations(seen: Observations, model: ErrorModel) -> None:
    """Raise BadMeasurement unless the parameters of a model can be identified from these."""
    count, joints = len(seen), len(model.nominal.slides)
    shapes = [np.shape(seen.joints), np.shape(seen.targets)]
    if seen.measured is None:
        fit = np.shape(seen.sockets) == (count,)
        shapes.append(np.shape(seen.sockets))
    else:
        fit = np.shape(seen.measured) in ((count, 3), (count, 4, 4))
        shapes.append(np.shape(seen.measured))
    if not fit or count == 0 or shapes[:2] != [(count, joints), (count,)]:
        valid = f"joints (n, {joints}), targets (n,), and (n, 3), (n, 4, 4) or sockets (n,), n > 0"
        raise BadMeasurement("shapes:", [size for shape in shapes for size in shape], valid)
    slides = model.nominal.slides
    tables = [
        ("joint angles of measurement", seen.joints[:, ~slides], TURNED, "rad"),
        ("joint positions of measurement", seen.joints[:, slides], FARTHEST, "m"),
    ]
    if seen.measured is not None:
        tables.append(("measurement", seen.measured, FARTHEST, "m in the base frame"))
    for what, values, most, unit in tables:
        wrong = ~(np.abs(values) <= most).reshape(count, -1).all(axis=1)
        if wrong.any():
            row = wrong.argmax()
            valid = f"numbers up to {most:.3g} ({unit})"
            raise BadMeasurement(f"{what} {row}", np.ravel(values[row]), valid)
    for what, numbers, most in (
        ("target", seen.targets, len(model.frames.targets)),
        ("socket", seen.sockets, len(model.frames.sockets)),
    ):
        if numbers is not None and not (np.isin(numbers, np.arange(most))).all():
            row = (~np.isin(numbers, np.arange(most))).argmax()
            raise BadMeasurement(f"{what} of measurement {row}", [numbers[row]], f"below {most}")
