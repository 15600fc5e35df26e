"""Errors over time, for the plots."""

from collections.abc import Mapping

import numpy as np
import rerun as rr

from recalib.study.measured import ERRORS, UNITS
from recalib.study.recording.clocks import measurements
from recalib.study.recording.colours import GREY
from recalib.study.recording.story import Motion, Watched

PUBLISHED = "paper"  # the entity's name beside those of the learners


def send_errors(
    rec: rr.RecordingStream, learner: str, colour: tuple, watched: Watched, motion: Motion
) -> None:
    """Mean errors over all test poses."""
    clock, rows = measurements(watched, motion)
    results = watched.history.columns()
    for quantity in ERRORS:
        entity, values = f"errors/{quantity}/{learner}", results[quantity][rows]
        rec.send_columns(entity, clock, rr.Scalars.columns(scalars=values))
        # a few moves in a moment are no noise to be averaged
        look = rr.SeriesLines(names=learner, colors=colour, widths=3, aggregation_policy="off")
        rec.log(entity, look, static=True)


def send_published(
    rec: rr.RecordingStream, published: Mapping[str, float], watched: Watched, motion: Motion
) -> None:
    """The published initial errors, where there are any, as straight lines in the plots."""
    clock, rows = measurements(watched, motion)
    for quantity, unit in zip(ERRORS, UNITS, strict=True):
        if quantity in published:
            entity, value = f"errors/{quantity}/{PUBLISHED}", published[quantity]
            line = np.full(len(rows), value)
            rec.send_columns(entity, clock, rr.Scalars.columns(scalars=line))
            name = f"the paper, before: {value} {unit}"
            rec.log(entity, rr.SeriesLines(names=name, colors=GREY, widths=1), static=True)
