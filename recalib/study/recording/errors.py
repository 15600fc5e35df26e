"""Errors over time, for the plots."""

from collections.abc import Mapping, Sequence

import numpy as np
import rerun as rr

from recalib.study.measured import ERRORS, UNITS
from recalib.study.recording.colours import GREY
from recalib.study.recording.scene import Scene

PUBLISHED = "paper"  # the entity's name beside those of the learners


def send_errors(scene: Scene, colour: Sequence[int]) -> None:
    """Mean errors over all test poses."""
    results = scene.watched.history.columns()
    # a few moves in a moment are no noise to be averaged
    style = rr.SeriesLines(names=scene.learner, colors=colour, widths=3, aggregation_policy="off")
    for quantity in ERRORS:
        _send(scene, quantity, scene.learner, results[quantity], style)


def send_published(scene: Scene, published: Mapping[str, float]) -> None:
    """The published initial errors, where there are any, as straight lines in the plots."""
    for quantity, unit in zip(ERRORS, UNITS, strict=True):
        if quantity in published:
            name = f"the paper, before: {published[quantity]} {unit}"
            level = np.full(len(scene.motion.moves), published[quantity])
            style = rr.SeriesLines(names=name, colors=GREY, widths=1)
            _send(scene, quantity, PUBLISHED, level, style)


def _send(
    scene: Scene, quantity: str, name: str, values: np.ndarray, style: rr.SeriesLines
) -> None:
    clock, rows = scene.motion.throughout()
    entity = f"errors/{quantity}/{name}"
    scene.rec.send_columns(entity, clock, rr.Scalars.columns(scalars=values[rows]))
    scene.rec.log(entity, style, static=True)
