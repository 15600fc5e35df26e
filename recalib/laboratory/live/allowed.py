"""The postures to which an arm may be sent, and the paths between them."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import islice

import numpy as np

from recalib.errors import InvalidSetting
from recalib.files.quantities import LENGTH
from recalib.identification.model.linearisation import LEVER
from recalib.laboratory.live.clearance import FLOOR, MARGIN, Clearance
from recalib.laboratory.propose import joint_limits
from recalib.nominal.kinematics import Arm
from recalib.numerics.randomness import generator
from recalib.station.guarded import REACHED
from recalib.station.interface import StationFailed

DRAWN, MOST = 2000, 400  # postures that are drawn, and of those that are allowed, kept
FEWEST = 20  # to choose from
STEP = 0.02  # rad, m of the fastest joint, between the postures of a path that are checked
Problem = tuple[str, str]  # what was found and what was expected, in words
_RANGE = re.compile(r"\s*(.+?)\s+to\s+(.+?)\s*")


@dataclass(frozen=True)
class Box:
    """Allowed range of the tool link's origin in the arm's base: low and high (3,) m."""

    low: np.ndarray
    high: np.ndarray

    @classmethod
    def read(cls, ranges: Sequence[str]) -> "Box":
        """From ranges of x, y and z, each as in `-40 cm to 40 cm`. Raises InvalidSetting."""
        ends = []
        for text in ranges:
            if not (found := _RANGE.fullmatch(text)):
                raise InvalidSetting("--box", text, "a range as in '-40 cm to 40 cm'")
            low, high = (LENGTH.value_of("--box", end) for end in found.groups())
            if low >= high:
                raise InvalidSetting("--box", text, "a range from its lower end to its upper end")
            ends.append((low, high))
        return cls(*np.array(ends).T)


class AllowedPostures:
    """Postures near home, within limits, to which a straight path in joint space leads from home.

    They follow from the arguments alone, so that a killed calibration goes on as it began.

    Args:
        home: (joints,) rad, m where the arm stood at first.
        limits: lower and upper (joints,) rad, m that the station allows; those of the URDF hold,
            too, and the outermost part of each joint's range is left out.
        span, box: see `LiveSettings`.
        clearance: what must not touch in postures and on paths; default: anything may.

    Raises InvalidSetting: home is not allowed, or hardly anything else.
    """

    def __init__(
        self,
        arm: Arm,
        home: np.ndarray,
        limits: tuple[np.ndarray, np.ndarray],
        span: float,
        box: Box | None = None,
        clearance: Clearance | None = None,
    ):
        self.home, self._arm, self._box = home, arm, box
        self._clearance = clearance if clearance and clearance.pairs else None
        lower, upper = joint_limits(arm)
        lower, upper = np.maximum(lower, limits[0]), np.minimum(upper, limits[1])
        reach = span * np.where(arm.slides, LEVER, 1.0)
        self._ranges = {
            "within its limits without their outermost part": (lower, upper),
            "within --span of the first posture": (home - reach, home + reach),
        }
        if problem := self._problem(home):
            raise InvalidSetting("the first posture", *problem)
        low, high = np.maximum(lower, home - reach), np.minimum(upper, home + reach)
        drawn = generator(0, "postures of a live calibration").uniform(low, high, (DRAWN, len(low)))
        # most fail at their ends, which are quickly looked at
        allowed = (end for end in drawn if not self._obstacle(end) and self._is_free(home, end))
        found = [*islice(allowed, MOST)]
        if len(found) < FEWEST:
            raise InvalidSetting(
                "--span",
                f"{np.degrees(span):.3g} deg, with {len(found)} of {DRAWN} postures allowed",
                f"at least {FEWEST}; try: more room, such as a wider --box or a lower --floor",
            )
        self.joints = np.array(found)  # (n, joints) rad, m, in the order in which they were drawn

    def tool(self, joints: np.ndarray) -> np.ndarray:
        """The nominal tool's position (3,) [m] in the arm's base."""
        return self._arm.forward(joints[None])[0, :3, 3]

    def path(self, start: np.ndarray, goal: np.ndarray) -> list[np.ndarray]:
        """Where to go in turn, to be at an allowed posture at last: straight, or by way of home.

        Raises StationFailed: the arm may not stand where it does, or no path leads from there.
        """
        straight = self._is_free(start, goal)
        self.check(start, start if straight else self.home)
        return [goal] if straight else [self.home, goal]

    def check(self, start: np.ndarray, goal: np.ndarray) -> None:
        """Raise StationFailed unless the arm may stand at start, and go straight to a posture.

        It may stand as far from where it was sent as a station may miss that.
        """
        if problem := self._problem(start, REACHED):
            raise self._refusal("stands", start, *problem)
        for posture in self._between(start, goal):
            if problem := self._obstacle(posture, REACHED):
                raise self._refusal("would pass", posture, *problem)

    def _refusal(self, what: str, joints: np.ndarray, found: str, expected: str) -> StationFailed:
        place = ", ".join(f"{1e3 * x:.0f}" for x in self.tool(joints))
        return StationFailed(
            f"the arm {what} with its tool at ({place}) mm and {found}; expected: {expected}; try:"
            " move it by hand to where the first row was measured"
        )

    def _between(self, start: np.ndarray, end: np.ndarray) -> np.ndarray:
        """Postures (n, joints) along a straight path, both ends with it."""
        count = 2 + int(np.abs(end - start).max() / STEP)
        return start + np.linspace(0, 1, count)[:, None] * (end - start)

    def _is_free(self, start: np.ndarray, end: np.ndarray) -> bool:
        """Whether nothing is in the way behind the start, which may be off by a little."""
        if self._box is None and self._clearance is None:
            return True
        return not any(self._obstacle(posture) for posture in self._between(start, end)[1:])

    def _problem(self, joints: np.ndarray, slack: float = 0.0) -> Problem | None:
        """Why the arm may not stand there; all bounds are wider by a slack [rad, m]."""
        for which, (low, high) in self._ranges.items():
            beyond = (joints < low - slack) | (joints > high + slack)
            if beyond.any():
                joint = int(beyond.argmax())
                scale, unit = (1e3, "mm") if self._arm.slides[joint] else (180 / np.pi, "deg")
                here, least, most = (f"{scale * ends[joint]:.1f}" for ends in (joints, low, high))
                found = f"{self._arm.joints[joint]} at {here} {unit}"
                return found, f"{least} to {most} {unit}, {which}"
        return self._obstacle(joints, slack)

    def _obstacle(self, joints: np.ndarray, slack: float = 0.0) -> Problem | None:
        """What is in the way there, if anything is."""
        if (box := self._box) is not None:
            place = self.tool(joints)
            if ((place < box.low - slack) | (place > box.high + slack)).any():
                where = ", ".join(f"{1e3 * x:.0f} mm" for x in place)
                return f"the tool at ({where})", "within --box"
        if self._clearance and (pair := self._clearance.touching(joints, MARGIN - slack)):
            option = "--floor" if FLOOR in pair else "--no-self-collision"
            found = f"{pair[0]} nearer than {1e3 * MARGIN:.0f} mm to {pair[1]}"
            return found, f"more room, or another {option} if this is wrong"
        return None
