"""When things are shown: the time columns of a recording."""

import numpy as np
import rerun as rr

from recalib.study.recording.story import Motion, Watched

Clock = list[rr.TimeColumn]


def clocks(watched: Watched, motion: Motion) -> tuple[Clock, Clock]:
    """Time columns of the frames of the first and the third act, and of the measurements."""
    acts = [rr.TimeColumn("time", duration=motion.times)]
    moves = rr.TimeColumn("moves", sequence=watched.history.moves)
    return acts, [moves, rr.TimeColumn("time", duration=motion.learning)]


def measurements(watched: Watched, motion: Motion) -> tuple[Clock, np.ndarray]:
    """Time columns of what is measured, and its rows in them.

    The first and the last measurement stand twice, so that on `time` they also fill the acts before
    and after learning.
    """
    rows = np.concatenate([[0], np.arange(len(motion.learning)), [-1]])
    seconds = np.concatenate([[0], motion.learning, [motion.end]])
    moves = watched.history.moves[rows]
    return [rr.TimeColumn("moves", sequence=moves), rr.TimeColumn("time", duration=seconds)], rows
