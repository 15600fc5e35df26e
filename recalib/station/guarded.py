"""A wrapper around an untrusted station: each call has a time limit, each answer is checked."""

import queue
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future, wait
from contextlib import suppress
from functools import partial
from typing import Any

import numpy as np

from recalib.arrays import numbers as numbers_in
from recalib.errors import InvalidSetting
from recalib.files.quantities import ANGLE
from recalib.nominal.kinematics import Arm
from recalib.station.interface import Station, StationFailed

PATIENCE = 120.0  # s, the most for a call: time for a slow move of all joints, a long exposure
REACHED = 0.01  # rad, m: the tolerance of a joint at its goal
STILL = 1e-4  # m, the most that a point on the tool may move during a standstill or a measurement
RADIUS = 0.1  # m from the tool link's origin to such a point, where a target may be mounted
READINGS, INTERVAL = 4, 0.05  # readings that establish a standstill, and the s between them
SETTLING = 5.0  # s within which the arm must come to a standstill
STOPPING = 10.0  # s, the most for a stop
AGAIN, REPEATS = 0.05, 20  # s until a stop is repeated while a call is not answered, and how often


class StationRaised(StationFailed):
    """A station raised an exception other than StationFailed, which suggests a bug in it."""


class Guarded:
    """The station that `opening` makes, with its joints in the order of the nominal arm.

    All calls except a stop come from one thread, which also opens the station, since drivers and
    graphics may be bound to a thread. After `stop`, the station is only stopped again or closed.

    The constructor and all methods that call the station raise StationFailed, with its mistake.
    """

    def __init__(self, opening: Callable[[], Station], arm: Arm):
        self._arm, self._stopped, self._hangs = arm, False, False
        self._calls = queue.SimpleQueue[tuple[Callable[[], Any], Future[Any]] | None]()
        self._asked = Future[Any]()  # the latest call's answer
        self._station: Station | None = None
        threading.Thread(target=self._work, name="station", daemon=True).start()
        self._station = self._ask("open", opening)
        if self._station is None:
            raise StationFailed("opening the station returned None; expected: a station")
        try:
            self._order = self._order_of_joints()
        except BaseException:
            self.stop()
            self.close()
            raise

    def _order_of_joints(self) -> list[int]:
        """The place of each joint of the arm among those of the station."""
        names = self._ask("name its joints", lambda station: [*station.joints])
        joints = self._arm.joints
        if sorted(map(str, names)) != sorted(joints):
            raise StationFailed(
                f"the station's joints are {', '.join(map(str, names))}; expected: those of the"
                f" arm, {', '.join(joints)}"
            )
        return [names.index(joint) for joint in joints]

    def limits(self) -> tuple[np.ndarray, np.ndarray]:
        """The lowest and highest joint angles (joints,) [rad, m] that the station allows."""

        def both(station: Station) -> tuple[Any, Any]:
            lower, upper = station.limits  # unpacked here, so that a mistake is the station's
            return lower, upper

        lower, upper = self._ask("report its limits", both)
        low, high = self._numbers("lower limits", lower), self._numbers("upper limits", upper)
        if (wrong := low >= high).any():
            joint = self._arm.joints[int(wrong.argmax())]
            found = f"the station's limits of {joint} are {low[wrong][0]:g} to {high[wrong][0]:g}"
            raise StationFailed(f"{found}; expected: the lower one first")
        return low, high

    def angles(self) -> np.ndarray:
        """The current joint angles (joints,) [rad, m]."""
        given = self._ask("report its angles", lambda station: station.angles())
        angles = self._numbers("angles", given)
        if (most := np.abs(angles[~self._arm.slides]).max(initial=0)) > ANGLE.farthest:
            valid = f"up to {ANGLE.write(ANGLE.farthest)}. Are they in rad?"
            raise StationFailed(f"the station's angles are up to {most:.3g} rad; expected: {valid}")
        return angles

    def move(self, goal: np.ndarray, speed: float) -> None:
        """Move to joint angles (joints,) [rad, m], and wait until the arm stands still there."""
        reordered = np.empty_like(goal)
        reordered[self._order] = goal
        self._ask("move", lambda station: station.move(reordered, speed))
        off = np.abs(self._standing() - goal)
        if off.max() > REACHED:
            joint = self._arm.joints[int(off.argmax())]
            raise StationFailed(
                f"after a move, {joint} is {off.max():.3g} rad or m from its command"
            )

    def measure(self) -> tuple[np.ndarray, Mapping[str, float | str] | None]:
        """Joint angles (joints,) [rad, m] and the measurement there; None if none is visible."""
        angles = self._standing()
        cells = self._ask("measure", lambda station: station.measure())
        if (moved := self._moved([angles, self.angles()])) > STILL:
            raise StationFailed(
                f"during a measurement, the tool moved by {1e3 * moved:.2g} mm; expected: at most"
                f" {1e3 * STILL:g} mm"
            )
        if cells is None:
            return angles, None
        if not isinstance(cells, Mapping) or not cells:
            raise StationFailed(f"the station measured {cells!r}; expected: cells by their headers")
        return angles, cells

    def stop(self) -> None:
        """Stop the station; all later calls are refused."""
        self._stopped = True

        def until_answered(station: Station) -> None:
            station.stop()
            for _ in range(REPEATS):  # a move that was about to begin may begin after the stop
                if wait([self._asked], AGAIN).done:
                    break
                station.stop()

        self._at_last(until_answered)

    def close(self) -> None:
        """Release the station: call its method `close`, if it has one.

        Graphics must be closed where they were opened, so this happens in its thread if possible.
        """
        self._stopped = True
        if self._station is not None:
            closed = self._call(partial(_close, self._station))
            if not wait([closed], 0 if self._hangs else STOPPING).done:
                self._at_last(_close)
        self._calls.put(None)

    def _at_last(self, do: Callable[[Station], None]) -> None:
        """Call the station even if it is busy: from a new thread, for a limited time."""

        def quietly(station: Station) -> None:  # only the failure before this one is reported
            with suppress(Exception):
                do(station)

        if self._station is not None:
            ending = threading.Thread(target=quietly, args=(self._station,), daemon=True)
            ending.start()
            ending.join(STOPPING)

    def _work(self) -> None:
        while (waiting := self._calls.get()) is not None:
            call, answer = waiting
            try:
                answer.set_result(call())
            except BaseException as error:
                answer.set_exception(error)

    def _call(self, call: Callable[[], Any]) -> Future[Any]:
        answer = Future[Any]()
        self._calls.put((call, answer))
        return answer

    def _ask(self, what: str, call: Callable[..., Any]) -> Any:
        def unless_stopped() -> Any:  # also if it was stopped while this call waited for its turn
            if self._stopped:
                raise StationFailed(f"the station was stopped, so it cannot {what}")
            return call() if self._station is None else call(self._station)

        self._asked = answer = self._call(unless_stopped)
        if not wait([answer], PATIENCE).done:
            self._hangs = True
            raise StationFailed(
                f"the station has not answered for {PATIENCE:g} s when asked to {what}"
            )
        error = answer.exception()
        if error is None or isinstance(error, StationFailed):
            return answer.result()
        raise StationRaised(
            f"when asked to {what}, the station raised {type(error).__name__}: {error}"
        ) from error

    def _standing(self) -> np.ndarray:
        """The joint angles (joints,) at a standstill, when several readings agree."""
        readings, until = [self.angles()], time.monotonic() + SETTLING
        while time.monotonic() < until or len(readings) < READINGS:
            time.sleep(INTERVAL)
            readings = [*readings[1 - READINGS :], self.angles()]
            if len(readings) == READINGS and self._moved(readings) <= STILL:
                return readings[-1]
        raise StationFailed(
            f"{SETTLING:g} s after the arm should have stopped, the tool still moves by"
            f" {1e3 * self._moved(readings):.2g} mm; expected: at most {1e3 * STILL:g} mm"
        )

    def _moved(self, readings: Sequence[np.ndarray]) -> float:
        """The largest motion [m] of a point near the tool between readings (joints,)."""
        poses = self._arm.forward(np.array(readings))
        gaps = poses[:, None, :3, 3] - poses[:, :3, 3]
        turns = np.linalg.norm(poses[:, None, :3, :3] - poses[:, :3, :3], axis=(2, 3)) / np.sqrt(2)
        return (np.linalg.norm(gaps, axis=2) + RADIUS * turns).max()

    def _numbers(self, name: str, given: Any) -> np.ndarray:
        """The numbers (joints,) in a station's answer, in the order of the arm's joints."""
        try:
            numbers = numbers_in(name, given)
        except InvalidSetting:
            raise StationFailed(f"the station's {name} are {given!r}; expected: numbers") from None
        if numbers.shape != (len(self._order),) or not np.isfinite(numbers).all():
            found, valid = numbers.tolist(), f"{len(self._order)} finite numbers"
            raise StationFailed(f"the station's {name} are {found}; expected: {valid}")
        return numbers[self._order]


def _close(station: Station) -> None:
    getattr(station, "close", lambda: None)()
