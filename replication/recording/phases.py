"""The three phases of a recording: the arm visits poses, learns, and visits them again."""

from dataclasses import dataclass

import numpy as np
import rerun as rr

ARM, MAP = "the arm", "the map"  # names of their views
# Plots have no clock of their own: that of the viewer counts iterations, so that their ticks do.
CLOCK = "iterations"
FRAMES_A_SECOND = 30
POSES = 12  # that the arm visits, if there are so many
# Frames of the visit of a pose: half of them it moves, half of them it rests there. Twelve visits
# are hundreds of frames: the viewer's ticks count from the first one, and so meet iteration 0.
VISIT = 50
BEFORE = 0  # the frame in which the arm rests at the last pose, not yet recalibrated

Clock = list[rr.TimeColumn]


@dataclass(frozen=True)
class Motion:
    """An arm visits the shown poses, waits at the last of them while it learns, and visits again.

    Frames are numbered so that those of the second phase are the iterations done until then: those
    of the first phase are negative.
    """

    frames: np.ndarray  # (frame,) those of all phases
    angles: np.ndarray  # (frame, joint) rad that the controller assumes
    # (2, pose) frames in which a move to a pose starts, in the first and the third phase
    departures: np.ndarray
    iterations: np.ndarray  # (measurement,) done until the measurements

    def clock(self) -> Clock:
        """When the frames are shown."""
        return [rr.TimeColumn(CLOCK, sequence=self.frames)]

    def measurements(self) -> tuple[Clock, np.ndarray]:
        """When the measurements are shown, and which of them then.

        The first and the last one stand twice: they fill the phases of visits, too.
        """
        rows = np.concatenate([[0], np.arange(len(self.iterations)), [-1]])
        shown = np.concatenate([self.frames[:1], self.iterations, self.frames[-1:]])
        return [rr.TimeColumn(CLOCK, sequence=shown)], rows


def move(angles: np.ndarray, iterations: np.ndarray, home: np.ndarray) -> Motion:
    """The motion that shows a training, from the home angles (joint,) [rad].

    Joints are sent to `angles` (measurement, pose, joint) [rad] for the shown poses, after so many
    iterations (measurement,).
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
    """Angles (stop x frame, joint) of smooth moves from `start` from stop to stop (stop, joint).

    `progress` (frame,) is the part of a way that is done, in [0, 1], if the arm moved evenly.
    """
    eased = (progress**2 * (3 - 2 * progress))[:, None]  # at rest at both ends
    starts = np.concatenate([start[None], stops[:-1]])[:, None]
    return (starts + eased * (stops[:, None] - starts)).reshape(-1, stops.shape[-1])
