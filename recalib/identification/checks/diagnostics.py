"""Checks of an identification: one that cannot be trusted is refused, with a reason in numbers."""

from collections.abc import Sequence

import numpy as np

from recalib.errors import RecalibError
from recalib.identification.calibration import Calibration
from recalib.identification.checks.gains import WrongGain, wrong_gain
from recalib.identification.checks.postures import Postures
from recalib.identification.checks.sequence import Fault, faults
from recalib.identification.model.observations import Observations
from recalib.nominal.kinematics import Arm

FEWEST = 10  # postures to hold some out
NOISIEST = 5e-3, np.radians(2)  # m, rad along an axis: so bad is no instrument, and no arm
NAMED = 5  # rows to look at first
# Of a link, of all links together, and, where axes meet, m: a change beyond all is no wear. The
# damage of the paper takes a tenth of a link, and a fortieth of them together.
OTHER_LINK, OTHER_ARM, OTHER_CROSSING = 0.2, 0.05, 0.02
# Axes as near to parallel count as parallel: far away along them, any length would be explained.
PARALLEL = 0.02


class Untrustworthy(RecalibError):
    """An identification of unknown or insufficient accuracy.

    Args:
        problem: what is wrong, in words.
        found: faults in the sequence of rows, which may be why.
        gain: a joint that does not turn as its column says, likewise.
    """

    def __init__(self, problem: str, found: Sequence[Fault] = (), gain: WrongGain | None = None):
        super().__init__(problem)
        self.faults, self.gain = found, gain


def check_postures(postures: Postures) -> Postures:
    """The same, if some of them can be held out. Raises Untrustworthy."""
    if len(postures) < FEWEST:
        raise Untrustworthy(
            f"there are {len(postures.numbers)} rows of {len(postures)}"
            f" posture{'s' * (len(postures) != 1)}; expected: at least {FEWEST} postures, spread"
            " over the joints' ranges"
        )
    return postures


def check_estimate(geometry: Calibration, observations: Observations) -> None:
    """Raise Untrustworthy unless an estimate of the geometry has converged and leaves noise."""
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
    """Raise Untrustworthy unless links are about as long as the nominal arm's.

    Wrong units and wrong names of sockets may be explained by another arm, without any noise.
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
    """Lengths (joints - 1,) [m] of the links from each joint's origin to the next, of both arms.

    An origin may lie anywhere on its joint's axis, and if the joint slides, anywhere at all: no
    measurement determines where. So the origins of the identified arm are moved, as far as they may
    be, to where its links are most like the nominal ones. What still differs does so wherever
    origins lie.
    """
    placements = [list(arm.model.jointPlacements)[2:] for arm in (nominal, identified)]
    right, found = (
        np.array([placement.translation for placement in arm]).reshape(-1, 3) for arm in placements
    )
    free = [  # directions in which each origin may be moved, in the frame of its joint
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
