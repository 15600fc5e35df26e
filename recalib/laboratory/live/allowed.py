"""The postures to which an arm may be sent, and the paths between them."""

import re
from dataclasses import dataclass

import numpy as np

from recalib.errors import InvalidSetting
from recalib.files.quantities import LENGTH
from recalib.identification.model.linearisation import LEVER
from recalib.laboratory.propose import joint_limits
from recalib.nominal.kinematics import Arm
from recalib.numerics.randomness import generator

DRAWN, MOST = 2000, 400  # postures that are drawn, and of those that are allowed, kept
FEWEST = 20  # to choose from
STEP = 0.02  # rad, m of the fastest joint, between the places of a path that are looked at
_BOX = re.compile(r"\s*(.+?)\s+to\s+(.+?)\s*")


@dataclass(frozen=True)
class Box:
    """Where the tool link's origin may be, in the arm's base: low and high (3,) m."""

    low: np.ndarray
    high: np.ndarray

    @classmethod
    def read(cls, text: str) -> "Box":
        """From ranges of x, y and z, as in `-40 cm to 40 cm, ...`. Raises InvalidSetting."""
        ranges = [_BOX.fullmatch(part) for part in text.split(",")]
        if len(ranges) != 3 or None in ranges:
            valid = "ranges of x, y and z, as in '-40 cm to 40 cm, 30 cm to 80 cm, 10 cm to 1 m'"
            raise InvalidSetting("--box", text, valid)
        low, high = np.array(
            [[LENGTH.value_of("--box", end) for end in its.groups()] for its in ranges if its]
        ).T
        if (low >= high).any():
            raise InvalidSetting("--box", text, "each range from its lower end to its upper end")
        return cls(low, high)


class AllowedPostures:
    """Postures near home, within limits, to which a straight path in joint space leads from home.

    They follow from the arguments alone, so that a killed calibration goes on as it began.

    Args:
        arm: the nominal one.
        home: (joints,) rad, m where the arm stood at first.
        limits: lower and upper (joints,) rad, m that the station allows; those of the URDF hold,
            too, and the outermost part of each joint's range is left out.
        span: rad that each joint may move either way from home; half a metre for each rad where it
            slides.
        box: in which the tool is in postures and on paths; anywhere unless given.

    Attributes:
        home: as given.
        joints: (n, joints) rad, m, in the order in which they were drawn.

    Raises InvalidSetting: home is not allowed, or hardly anything else.
    """

    def __init__(
        self,
        arm: Arm,
        home: np.ndarray,
        limits: tuple[np.ndarray, np.ndarray],
        span: float,
        box: Box | None,
    ):
        self.home, self._arm, self._box = home, arm, box
        lower, upper = joint_limits(arm)
        lower, upper = np.maximum(lower, limits[0]), np.minimum(upper, limits[1])
        if (beyond := (home < lower) | (home > upper)).any():
            joint = arm.joints[beyond.argmax()]
            raise InvalidSetting(
                "the first posture",
                f"{joint} at {home[beyond.argmax()]:.4g}",
                f"{lower[beyond.argmax()]:.4g} to {upper[beyond.argmax()]:.4g} (rad, m): its limits"
                " without their outermost part",
            )
        if not self._inside(home[None]):
            place = ", ".join(f"{1e3 * x:.0f} mm" for x in arm.forward(home[None])[0, :3, 3])
            raise InvalidSetting("--box", f"without the tool, which is at ({place})", "around it")
        reach = span * np.where(arm.slides, LEVER, 1.0)
        low, high = np.maximum(lower, home - reach), np.minimum(upper, home + reach)
        drawn = generator(0, "postures of a live calibration").uniform(low, high, (DRAWN, len(low)))
        if box is not None:  # most fail at their ends, which are quickly looked at
            drawn = drawn[self._contained(drawn)]
        found = []
        for posture in drawn:
            if self._inside(self._between(home, posture)):
                found.append(posture)
            if len(found) == MOST:
                break
        if len(found) < FEWEST:
            raise InvalidSetting(
                "--box", f"left by all but {len(found)} of {DRAWN} postures", "wider"
            )
        self.joints = np.array(found)

    def path(self, start: np.ndarray, goal: np.ndarray) -> list[np.ndarray] | None:
        """Where to go in turn, to be at a posture at last: straight, or by way of home.

        None where all straight paths from the start leave the box.
        """
        if self._inside(self._between(start, goal)):
            return [goal]
        return [self.home, goal] if self._inside(self._between(start, self.home)) else None

    def _between(self, start: np.ndarray, end: np.ndarray) -> np.ndarray:
        """Postures (n, joints) along a straight path, both ends with it."""
        count = 2 + int(np.abs(end - start).max() / STEP)
        return start + np.linspace(0, 1, count)[:, None] * (end - start)

    def _inside(self, joints: np.ndarray) -> bool:
        return self._box is None or bool(self._contained(joints).all())

    def _contained(self, joints: np.ndarray) -> np.ndarray:
        """Whether the nominal tool is in the box (n,)."""
        assert self._box is not None
        places = self._arm.forward(joints)[:, :3, 3]
        return np.all((places >= self._box.low) & (places <= self._box.high), axis=1)
