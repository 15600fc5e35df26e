"""Checks of an identification, which refuse an untrustworthy one and quantify the reason."""

from collections.abc import Sequence

import numpy as np

from recalib.errors import RecalibError
from recalib.identification.calibration import Calibration
from recalib.identification.checks.gains import WrongGain, wrong_gain
from recalib.identification.checks.postures import Postures
from recalib.identification.checks.sequence import Fault, faults
from recalib.identification.model.observations import Observations
from recalib.nominal.kinematics import Arm

FEWEST = 10  # the least number of postures for cross-validation
NOISIEST = 5e-3, np.radians(2)  # m, rad along an axis: no arm or instrument is as inaccurate
NAMED = 5  # rows that a message lists
# Limits on the wear of a link, of which the largest holds: fractions of its length and of all links
# together, and m, for axes that meet. The paper's damage is a tenth of a link, a fortieth of all.
OTHER_LINK, OTHER_ARM, OTHER_CROSSING = 0.2, 0.05, 0.02
# lstsq's rcond, so that almost parallel axes count as parallel: far along them, any length fits.
PARALLEL = 0.02


class Untrustworthy(RecalibError):
    """An identification of unknown or insufficient accuracy.

    Args:
        problem: the problem, in words.
        found: faults in the sequence of rows, which may be the reason.
        gain: a joint that does not turn as its column says, which may be the reason.
    """

    def __init__(self, problem: str, found: Sequence[Fault] = (), gain: WrongGain | None = None):
        super().__init__(problem)
        self.faults, self.gain = found, gain


def check_postures(postures: Postures) -> Postures:
    """The given postures. Raises Untrustworthy: too few to hold some out."""
    if len(postures) < FEWEST:
        raise Untrustworthy(
            f"there are {len(postures.numbers)} rows of {len(postures)}"
            f" posture{'s' * (len(postures) != 1)}; expected: at least {FEWEST} postures, spread"
            " over the joints' ranges"
        )
    return postures


def check_estimate(geometry: Calibration, observations: Observations) -> None:
    """Raise Untrustworthy unless the geometry's estimate converged, with plausible residuals."""
    noise = geometry.estimate.noise
    if not geometry.estimate.converged:
        raise Untrustworthy(
            "the identification of the geometry did not converge, with a noise of"
            f" {1e3 * noise[0]:.2g} mm; try: more rows, in more diverse postures"
        )
    if (noise > NOISIEST[: len(noise)]).any():
        found = [f"{1e3 * noise[0]:.1f} mm", *(f"{np.degrees(turn):.1f} deg" for turn in noise[1:])]
        residuals = geometry.residuals(observations) / np.repeat(noise, 3)
        rows = np.argsort(-np.square(residuals).sum(axis=1), kind="stable")[:NAMED] + 1
        raise Untrustworthy(
            f"residuals of the best fit are {' and '.join(found)} along each axis, the largest in"
            f" rows {', '.join(map(str, rows))} (the first is 1); expected: up to"
            f" {1e3 * NOISIEST[0]:.0f} mm and {np.degrees(NOISIEST[1]):.0f} deg",
            faults(geometry, observations),
            wrong_gain(geometry, observations),
        )


def check_links(geometry: Calibration) -> None:
    """Raise Untrustworthy unless links are about as long as the nominal ones.

    An arm of other lengths may explain wrong units or wrong names of sockets without any residuals.
    """
    nominal = geometry.model.nominal
    right, found = link_lengths(nominal, geometry.model.own_arm(geometry.estimate.parameters))
    limits = np.maximum(OTHER_LINK * right, max(OTHER_ARM * right.sum(), OTHER_CROSSING))
    beyond = np.abs(found - right) - limits
    if (beyond > 0).any():
        worst = int(beyond.argmax())
        names = ", or other names of sockets" if geometry.model.frames.sockets.size else ""
        ends = " and ".join(nominal.joints[worst : worst + 2])
        raise Untrustworthy(
            f"the link between {ends} is {1e3 * found[worst]:.0f} mm long by the measurements;"
            f" expected: about {1e3 * right[worst]:.0f} mm, as in the URDF; try: other units or"
            f" another URDF{names}"
        )


def link_lengths(nominal: Arm, identified: Arm) -> tuple[np.ndarray, np.ndarray]:
    """Lengths (joints - 1,) [m] of both arms' links, from each joint's origin to the next.

    No measurement determines where an origin lies along its joint's axis, or where the origin of a
    prismatic joint lies at all. So the identified arm's origins are moved, within this freedom, to
    where its links are most similar to the nominal ones. The remaining differences are real.
    """
    placements = [list(arm.model.jointPlacements)[2:] for arm in (nominal, identified)]
    right, found = (
        np.array([placement.translation for placement in arm]).reshape(-1, 3) for arm in placements
    )
    free = [  # directions in which each origin may move, in the frame of its joint
        np.eye(3) if slides else np.outer(axis, axis)
        for slides, axis in zip(nominal.slides, nominal.axes, strict=True)
    ]
    columns = np.zeros((*found.shape, len(free), 3))
    for link, placement in enumerate(placements[1]):
        columns[link, :, link] = -free[link]
        columns[link, :, link + 1] = placement.rotation @ free[link + 1]
    slopes = columns.reshape(found.size, 3 * len(free))
    moves = slopes @ np.linalg.lstsq(slopes, (right - found).ravel(), rcond=PARALLEL)[0]
    return np.linalg.norm(right, axis=1), np.linalg.norm(found + moves.reshape(-1, 3), axis=1)
