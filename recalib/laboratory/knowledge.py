"""What a description says beside a table: frames and distances, compared with what was measured.

It is believed as far as an arm can be as it says. A turn the wrong way, inches, or the frame of
something else would make another arm.
"""

from collections.abc import Sequence
from contextlib import suppress
from itertools import combinations

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.errors import RecalibError
from recalib.identification.first_guess import FARTHEST, NoFirstGuess, guess_frames, typical_miss
from recalib.identification.frames import Frames
from recalib.identification.observations import Observations
from recalib.nominal.kinematics import Arm

ALIKE = 2.0  # times the least that is missed: as good an explanation
STRETCHED = 0.2  # of a distance: so much longer or shorter than its description is no arm


class WrongKnowledge(RecalibError):
    """What a description says is not what the measurements say. Attributes: part, of it."""

    def __init__(self, part: str, reason: str):
        self.part = part
        super().__init__(f"the description's {part} {reason}")


def first_frames(
    arm: Arm,
    seen: Observations,
    instrument: np.ndarray | None = None,
    target: np.ndarray | None = None,
) -> Frames:
    """The frames at both ends of the nominal arm, to start an identification from.

    Args:
        instrument: (4, 4) m in the arm's base frame, where it is known.
        target: (4, 4) m in the tool link's frame, where it is known, the same for all targets.

    Raises WrongKnowledge: without one of them that is given, the measurements are explained.
    NoFirstGuess: nothing explains them.
    """
    given = {"instrument": instrument, "target": target}
    given = {part: pose for part, pose in given.items() if pose is not None}
    try:
        return _frames(arm, seen, **given)
    except NoFirstGuess as error:
        problem = error
    without = {}
    for wrong in [*combinations(given, 1), *combinations(given, 2)]:
        right = {part: pose for part, pose in given.items() if part not in wrong}
        with suppress(NoFirstGuess):
            without[wrong] = _frames(arm, seen, **right)
    if not without:
        raise problem
    missed = {wrong: typical_miss(frames, arm, seen) for wrong, frames in without.items()}
    likely = [wrong for wrong in missed if missed[wrong] <= ALIKE * min(missed.values())]
    wrong = min(likely, key=lambda parts: (len(parts), missed[parts]))
    found = {
        "instrument": np.linalg.inv(without[wrong].base),
        "target": without[wrong].targets[0],
    }
    raise WrongKnowledge(
        " and ".join(f"[{part}]" for part in wrong),
        " and ".join(_gap(given[part], found[part]) for part in wrong)
        + "; what is left out of the description is found",
    )


def check_distances(arm: Arm, seen: Observations, frames: Frames, names: Sequence[str]) -> None:
    """Raise WrongKnowledge where sockets are not as far apart as the nominal arm has them, about.

    Args:
        frames: a first guess of them.
        names: of the sockets.
    """
    for one, other, length, _ in seen.distances:
        nominal = np.linalg.norm(frames.sockets[one] - frames.sockets[other])
        if abs(length - nominal) > STRETCHED * nominal + typical_miss(frames, arm, seen):
            raise WrongKnowledge(
                f"distance between {names[one]} and {names[other]}",
                f"is {1e3 * length:.5g} mm; by the arm's description they are"
                f" {1e3 * nominal:.5g} mm apart; expected that, but for"
                f" {100 * STRETCHED:.0f} percent",
            )


def _frames(
    arm: Arm,
    seen: Observations,
    instrument: np.ndarray | None = None,
    target: np.ndarray | None = None,
) -> Frames:
    base = None if instrument is None else np.linalg.inv(instrument)
    if base is None or target is None:
        return guess_frames(arm, seen, base, target)
    frames = Frames(base, np.tile(target, (seen.targets.max() + 1, 1, 1)))
    if (missed := typical_miss(frames, arm, seen)) > FARTHEST:
        raise NoFirstGuess(
            "with instrument and target where the description has them, the measurements are"
            f" {1e3 * missed:.0f} mm from where the arm would be; expected up to"
            f" {1e3 * FARTHEST:.0f} mm; try without [instrument] and [target]"
        )
    return frames


def _gap(given: np.ndarray, found: np.ndarray) -> str:
    """How far apart two poses (4, 4) [m] are, and the other one as a description would have it."""
    gap = np.linalg.inv(given) @ found
    shift = 1e3 * np.linalg.norm(gap[:3, 3])
    angle = np.degrees(Rotation.from_matrix(gap[:3, :3]).magnitude())
    place = ", ".join(f'"{1e3 * each:.0f} mm"' for each in found[:3, 3])
    angles = Rotation.from_matrix(found[:3, :3]).as_euler("xyz", degrees=True)
    turn = ", ".join(f'"{each:.0f} deg"' for each in angles)
    return (
        f"is {shift:.0f} mm and {angle:.0f} deg from where the measurements put it; expected about"
        f" position = [{place}], roll_pitch_yaw = [{turn}]"
    )
