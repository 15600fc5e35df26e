"""An identification that cannot be trusted is refused, by its reason and with numbers."""

import numpy as np

from recalib.errors import RecalibError
from recalib.identification.estimation import Estimate
from recalib.identification.postures import Postures

FEWEST = 10  # postures to hold some out
NOISIEST = 5e-3, np.radians(2)  # m, rad along an axis: so bad is no instrument, and no arm
NAMED = 5  # rows to look at first


class TooFewPostures(RecalibError):
    """Fewer postures than it takes to say what an identification is worth."""

    def __init__(self, postures: int, rows: int):
        self.postures, self.rows = postures, rows
        super().__init__(
            f"there are {rows} rows of {postures} posture{'s' * (postures != 1)}; valid: at least"
            f" {FEWEST} postures, all over the joints' ranges"
        )


class NotConverged(RecalibError):
    """An identification that was still changing when it was stopped.

    Attributes: noise, as `Estimate.noise` then.
    """

    def __init__(self, noise: np.ndarray):
        self.noise = noise
        super().__init__(
            "the geometry was still changing when its identification was stopped, with a noise of"
            f" {1e3 * noise[0]:.2g} mm; valid: more rows, in postures less alike"
        )


class Implausible(RecalibError):
    """What is left between the arm and its measurements is no noise.

    Attributes: noise, as `Estimate.noise`, and rows (from 0), those that are farthest off.
    """

    def __init__(self, noise: np.ndarray, rows: np.ndarray):
        self.noise, self.rows = noise, rows
        found = [f"{1e3 * noise[0]:.1f} mm", *(f"{np.degrees(turn):.1f} deg" for turn in noise[1:])]
        listed = ", ".join(str(row + 1) for row in rows)
        super().__init__(
            f"the best arm still misses by {' and '.join(found)} along each axis, most of all in"
            f" rows {listed} (the first is 1); valid: up to {1e3 * NOISIEST[0]:.0f} mm and"
            f" {np.degrees(NOISIEST[1]):.0f} deg"
        )


def check_postures(postures: Postures) -> Postures:
    """The same, if some of them can be held out. Raises TooFewPostures."""
    if len(postures) < FEWEST:
        raise TooFewPostures(len(postures), len(postures.numbers))
    return postures


def check_estimate(estimate: Estimate) -> None:
    """Raise NotConverged or Implausible unless an estimate of the geometry can be trusted."""
    if not estimate.converged:
        raise NotConverged(estimate.noise)
    if (estimate.noise > NOISIEST[: len(estimate.noise)]).any():
        raise Implausible(estimate.noise, np.argsort(estimate.weights, kind="stable")[:NAMED])
