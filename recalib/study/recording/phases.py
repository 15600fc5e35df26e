"""The three phases of a recording: the arm visits poses, learns, and visits them again."""

from dataclasses import dataclass

import numpy as np
import rerun as rr

ARM = "the arm"  # the view of the first learner's
FRAMES_A_SECOND = 25
POSES = 12  # that the arm visits
VISITS = 19.2  # seconds in which it visits them: half of them it moves, half of them it rests there
LEARNING = 10.0  # seconds in which the longest training is shown
END = 2 * VISITS + LEARNING
BEFORE = VISITS - 0.4  # seconds: the arm rests at the last pose, not yet recalibrated
AFTER = BEFORE + LEARNING + VISITS  # the same, recalibrated

Clock = list[rr.TimeColumn]


@dataclass(frozen=True)
class Motion:
    """An arm visits the shown poses, waits at the last of them while it learns, and visits again.

    Attributes:
        times: (frame,) seconds from the start, in the first and the third phase.
        angles: (frame, joint) rad that the controller believes in.
        departures, arrivals: (2, pose) seconds at which a move to a pose starts and ends, in the
            first and the third phase.
        learning: (measurement,) seconds of the second phase at which the measurements are shown.
        moves: (measurement,) of the robot until each of them.
    """

    times: np.ndarray
    angles: np.ndarray
    departures: np.ndarray
    arrivals: np.ndarray
    learning: np.ndarray
    moves: np.ndarray

    def visits(self) -> Clock:
        """When the frames of the first and the third phase are shown."""
        return [rr.TimeColumn("time", duration=self.times)]

    def measurements(self) -> Clock:
        """When the measurements are shown."""
        moves = rr.TimeColumn("moves", sequence=self.moves)
        return [moves, rr.TimeColumn("time", duration=self.learning)]

    def throughout(self) -> tuple[Clock, np.ndarray]:
        """When the measurements are shown in all phases, and which of them then.

        The first and the last one stand twice: on `time` they fill the phases of visits, too.
        """
        rows = np.concatenate([[0], np.arange(len(self.learning)), [-1]])
        seconds = np.concatenate([[0], self.learning, [END]])
        moves = rr.TimeColumn("moves", sequence=self.moves[rows])
        return [moves, rr.TimeColumn("time", duration=seconds)], rows


def move(angles: np.ndarray, moves: np.ndarray, home: np.ndarray, most: int) -> Motion:
    """The motion that shows a training, from the home angles (joint,) [rad].

    Args:
        angles: (measurement, pose, joint) rad that the joints are sent to for the shown poses.
        moves: (measurement,) of the robot until then.
        most: moves of the longest training that is shown beside it: all share one clock.
    """
    before, after = angles[0], angles[-1]
    visit = VISITS / len(before)
    starts = np.array([0, VISITS + LEARNING])
    departures = starts[:, None] + np.arange(len(before)) * visit
    clock = np.arange(round(visit * FRAMES_A_SECOND)) / FRAMES_A_SECOND
    done = np.minimum(clock / (visit / 2), 1)
    return Motion(
        times=(departures[:, :, None] + clock).ravel(),
        angles=np.concatenate([_visits(home, before, done), _visits(after[-1], after, done)]),
        departures=departures,
        arrivals=departures + visit / 2,
        learning=VISITS + LEARNING * moves / max(most, 1),
        moves=moves,
    )


def _visits(start: np.ndarray, stops: np.ndarray, done: np.ndarray) -> np.ndarray:
    """Angles (stop x frame, joint) of smooth moves from `start` from stop to stop (stop, joint).

    Args:
        done: (frame,) of each way, in [0, 1], if the arm moved evenly.
    """
    eased = (done**2 * (3 - 2 * done))[:, None]  # at rest at both ends
    starts = np.concatenate([start[None], stops[:-1]])[:, None]
    return (starts + eased * (stops[:, None] - starts)).reshape(-1, stops.shape[-1])
