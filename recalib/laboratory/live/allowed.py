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

DRAWN, MOST = 2000, 400  # postures that are drawn, and allowed ones that are kept
FEWEST = 20  # allowed postures
STEP = 0.02  # rad, m: largest motion of a joint between two checked postures of a path
Problem = tuple[str, str]  # the finding and the expectation, in words
_RANGE = re.compile(r"\s*(.+?)\s+to\s+(.+?)\s*")


@dataclass(frozen=True)
class Box:
    """Allowed range of the tool link's origin in the arm's base: low and high (3,) m."""

    low: np.ndarray
    high: np.ndarray

    @classmethod
    def read(cls, ranges: Sequence[str]) -> "Box":
        """Read ranges of x, y and z, such as `-40 cm to 40 cm`. Raises InvalidSetting."""
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
    """Postures near home, within limits, that the arm can reach on a straight path in joint space.

    They depend only on the arguments, so that a killed calibration can continue with the same ones.

    Args:
        home: (joints,) rad, m, the first posture.
        limits: lower and upper (joints,) rad, m of the station; those of the URDF apply, too,
            without the outermost part of each joint's range.
        span, box: see `LiveSettings`.
        clearance: the shapes that must keep apart in postures and on paths (default: none).

    Raises InvalidSetting if home is not allowed, or too few other postures are.
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
            "within its limits, without the outermost part": (lower, upper),
            "within --span of the first posture": (home - reach, home + reach),
        }
        if problem := self._problem(home):
            raise InvalidSetting("the first posture", *problem)
        low, high = np.maximum(lower, home - reach), np.minimum(upper, home + reach)
        drawn = generator(0, "postures of a live calibration").uniform(low, high, (DRAWN, len(low)))
        # most fail at the end of their path, which is quick to check first
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
        """The postures to go to in turn to reach a goal: straight there, or by way of home."""
        return [goal] if self._is_free(start, goal) else [self.home, goal]

    def check(self, start: np.ndarray, goal: np.ndarray) -> None:
        """Raise StationFailed unless the arm may stand at start and go straight to the goal.

        All bounds are wider by the largest error with which a station may reach a posture.
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
        """Postures (n, joints) along a straight path, including both ends."""
        count = 2 + int(np.abs(end - start).max() / STEP)
        return start + np.linspace(0, 1, count)[:, None] * (end - start)

    def _is_free(self, start: np.ndarray, end: np.ndarray) -> bool:
        """Whether the path is free after its start, where the arm may stand slightly off."""
        if self._box is None and self._clearance is None:
            return True
        return not any(self._obstacle(posture) for posture in self._between(start, end)[1:])

    def _problem(self, joints: np.ndarray, slack: float = 0.0) -> Problem | None:
        """Why a posture is not allowed, if so; all bounds are wider by the slack [rad, m]."""
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
        """The violation of box or clearance in a posture, if there is one."""
        if (box := self._box) is not None:
            place = self.tool(joints)
            if ((place < box.low - slack) | (place > box.high + slack)).any():
                where = ", ".join(f"{1e3 * x:.0f} mm" for x in place)
                return f"the tool at ({where})", "within --box"
        if self._clearance and (pair := self._clearance.touching(joints, MARGIN - slack)):
            option = "another --floor" if FLOOR in pair else "--no-self-collision"
            found = f"{pair[0]} nearer than {1e3 * MARGIN:.0f} mm to {pair[1]}"
            return found, f"more room, or {option} if this is wrong"
        return None
