"""The three phases of a recording: the arm visits poses, learns, and visits them again."""

from dataclasses import dataclass

import numpy as np
import rerun as rr

ARM, MAP = "the arm", "the map"  # names of their views
# Plots use the viewer's timeline, so it counts iterations, to have these as ticks.
CLOCK = "iterations"
FRAMES_A_SECOND = 30
POSES = 12  # poses that the arm visits, at most
# Frames of a visit: in one half the arm moves, in the other it rests. Twelve visits are a multiple
# of 100 frames: the viewer's ticks count from the first frame, and so one is at iteration 0.
VISIT = 50
BEFORE = 0  # the frame in which the arm rests at the last pose before learning

Clock = list[rr.TimeColumn]


@dataclass(frozen=True)
class Motion:
    """The arm visits the shown poses, waits at the last while it learns, and visits all again.

    The numbers of frames in the second phase are numbers of iterations, so those in the first phase
    are negative.
    """

    frames: np.ndarray  # (frame,) numbers of the frames of all phases
    angles: np.ndarray  # (frame, joint) rad, joint angles of the controller
    # (2, pose) frames in which a move to a pose starts, in the first and the third phase
    departures: np.ndarray
    iterations: np.ndarray  # (measurement,) numbers of iterations before each measurement

    def measurements(self) -> tuple[Clock, np.ndarray]:
        """The times at which measurements are shown, and their indices.

        The first and the last measurement occur twice, because they are also shown during visits.
        """
        rows = np.concatenate([[0], np.arange(len(self.iterations)), [-1]])
        shown = np.concatenate([self.frames[:1], self.iterations, self.frames[-1:]])
        return [rr.TimeColumn(CLOCK, sequence=shown)], rows


def move(angles: np.ndarray, iterations: np.ndarray, home: np.ndarray) -> Motion:
    """The motion that shows a training, from the home angles (joint,) [rad].

    `angles` (measurement, pose, joint) [rad] are joint angles for the shown poses after
    `iterations` (measurement,).
    """
    before, after = angles[0], angles[-1]
    departures = VISIT * np.arange(len(before))
    starts = np.array([[-VISIT * len(before)], [iterations[-1] + 1]])
    visits = starts + np.arange(VISIT * len(before))
    progress = np.minimum(np.arange(VISIT) / (VISIT / 2), 1)
    return Motion(
        frames=np.concatenate([visits[0], iterations, visits[1]]),
        angles=np.concatenate(
            [_visits(home, before, progress), angles[:, -1], _visits(after[-1], after, progress)]
        ),
        departures=starts + departures,
        iterations=iterations,
    )


def _visits(start: np.ndarray, stops: np.ndarray, progress: np.ndarray) -> np.ndarray:
    """Angles (stop x frame, joint) of smooth moves from `start` (joint,) to stops (stop, joint).

    `progress` (frame,) is the completed part of a move, in [0, 1], at constant speed.
    """
    eased = (progress**2 * (3 - 2 * progress))[:, None]  # at rest at both ends
    starts = np.concatenate([start[None], stops[:-1]])[:, None]
    return (starts + eased * (stops[:, None] - starts)).reshape(-1, stops.shape[-1])
