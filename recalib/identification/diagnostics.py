"""Checks of an identification: one that cannot be trusted is refused, with a reason in numbers."""

import numpy as np

from recalib.errors import RecalibError
from recalib.identification.estimation import Estimate
from recalib.identification.postures import Postures

FEWEST = 10  # postures to hold some out
NOISIEST = 5e-3, np.radians(2)  # m, rad along an axis: so bad is no instrument, and no arm
NAMED = 5  # rows to look at first


class Untrustworthy(RecalibError):
    """An identification whose accuracy cannot be known, or that has none."""


def check_postures(postures: Postures) -> Postures:
    """The same, if some of them can be held out. Raises Untrustworthy."""
    if len(postures) < FEWEST:
        raise Untrustworthy(
            f"there are {len(postures.numbers)} rows of {len(postures)}"
            f" posture{'s' * (len(postures) != 1)}; expected: at least {FEWEST} postures, all over"
            " the joints' ranges"
        )
    return postures


def check_estimate(estimate: Estimate) -> None:
    """Raise Untrustworthy unless an estimate of the geometry has converged and leaves noise."""
    noise = estimate.noise
    if not estimate.converged:
        raise Untrustworthy(
            "the geometry was still changing when its identification was stopped, with a noise of"
            f" {1e3 * noise[0]:.2g} mm; try: more rows, in postures less alike"
        )
    if (noise > NOISIEST[: len(noise)]).any():
        found = [f"{1e3 * noise[0]:.1f} mm", *(f"{np.degrees(turn):.1f} deg" for turn in noise[1:])]
        rows = np.argsort(estimate.weights, kind="stable")[:NAMED] + 1
        raise Untrustworthy(
            f"residuals of the best fit are {' and '.join(found)} along each axis, the largest in"
            f" rows {', '.join(map(str, rows))} (the first is 1); expected: up to"
            f" {1e3 * NOISIEST[0]:.0f} mm and {np.degrees(NOISIEST[1]):.0f} deg"
        )
