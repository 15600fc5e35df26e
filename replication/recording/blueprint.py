"""How the viewer arranges a recording when it opens."""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
import rerun as rr
import rerun.blueprint as rrb

from replication.recording.colours import BACKGROUND
from replication.recording.measurements import PUBLISHED
from replication.recording.phases import ARM, CLOCK, FRAMES_A_SECOND
from replication.recording.sight import Sight
from replication.recording.watched import Watched
from replication.training.competitors import label_of

TITLES = {
    "position_error_cm": "mean position error [cm] over iterations",
    "orientation_error_deg": "mean orientation error [degrees] over iterations",
}
LEAST = 0.1  # cm and degrees, to which a plot reaches at least


def arrange(
    watched: Mapping[str, Watched], sight: Sight, published: Mapping[str, float]
) -> rrb.Blueprint:
    """Tabs: the arm with the first learner, and all learners side by side where there are several.

    Args:
        published: initial errors, if there are any.
    """
    learners = list(watched)
    arm = rrb.Horizontal(
        # the text on the left, because the viewer's notices pop up on the right
        rrb.Vertical(
            rrb.TextDocumentView(origin="about", name="what you see"),
            *_plots(learners[:1], watched, published),
            row_shares=[12, 8, 8],
        ),
        _scene(ARM, learners[0], sight),
        column_shares=[3, 5],
        name="the arm before and after",
    )
    beside = rrb.Vertical(
        rrb.Horizontal(*(_scene(label_of(name), name, sight) for name in learners)),
        rrb.Horizontal(
            rrb.TextDocumentView(origin="beside", name="what you see"),
            *_plots(learners, watched, published),
        ),
        row_shares=[5, 3],
        name="the learners side by side",
    )
    return rrb.Blueprint(
        rrb.Tabs(*([arm, beside] if len(learners) > 1 else [arm]), active_tab=0),
        rrb.TimePanel(
            state="collapsed",
            timeline=CLOCK,
            fps=FRAMES_A_SECOND,
            play_state="playing",
            loop_mode="all",
        ),
        rrb.BlueprintPanel(state="hidden"),
        rrb.SelectionPanel(state="hidden"),
    )


def _scene(name: str, learner: str, sight: Sight) -> rrb.Spatial3DView:
    """A view of a learner's arm."""
    return rrb.Spatial3DView(
        origin="/",
        contents=["/workspace/**", "/desired/**", "/legend/**", f"/{learner}/**"],
        name=name,
        background=BACKGROUND,
        eye_controls=rrb.EyeControls3D(
            position=sight.eye, look_target=sight.target, eye_up=(0, 0, 1)
        ),
    )


def _plots(
    learners: Sequence[str], watched: Mapping[str, Watched], published: Mapping[str, float]
) -> Iterable[rrb.TimeSeriesView]:
    learned = max(its.history.iterations[-1] for its in watched.values())
    # beyond the last iteration, or its own number would have no room
    bounds = (rrb.TimeRangeBoundary.absolute(seq=end) for end in (0, round(1.1 * learned)))
    iterations = rrb.TimeAxis(view_range=rr.TimeRange(*bounds))
    for quantity, title in TITLES.items():
        errors = [watched[learner].history.columns()[quantity].max() for learner in learners]
        top = _end(max(*errors, published.get(quantity, 0), LEAST))
        yield rrb.TimeSeriesView(
            origin=f"errors/{quantity}",
            contents=[f"$origin/{series}" for series in (PUBLISHED, *learners)],
            name=title,
            axis_x=iterations,
            axis_y=rrb.ScalarAxis(range=(-0.02 * top, top)),
            plot_legend=rrb.Corner2D.RightTop,
        )


def _end(largest: float) -> float:
    """Where an axis ends: a power of ten is in sight, as the viewer may label no other number."""
    power = 10 ** np.ceil(np.log10(largest))
    return 1.05 * power if largest > power / 2 else 1.1 * largest
