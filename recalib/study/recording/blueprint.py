"""How the viewer arranges a recording when it opens."""

from collections.abc import Iterable, Mapping

import numpy as np
import rerun.blueprint as rrb

from recalib.nominal.poses import Workspace
from recalib.study.recording.scene import PUBLISHED, logarithm
from recalib.study.recording.story import Watched

TITLES = {
    "position_error_cm": "position error, log10 of cm  (1 = 10 cm, 0 = 1 cm, -1 = 1 mm)",
    "orientation_error_deg": "orientation error, log10 of degrees  (1 = 10°, 0 = 1°, -1 = 0.1°)",
}
MARGIN = 0.2  # of the plots, above and below whole decades


def arrange(
    watched: Mapping[str, Watched], workspace: Workspace, published: Mapping[str, float]
) -> rrb.Blueprint:
    """Tabs: the arm with the first learner, and all learners side by side where there are several.

    Args:
        watched: by learner.
        published: initial errors, where there are any.
    """
    learners = list(watched)
    arm = rrb.Horizontal(
        # the text on the left, because the viewer's notices pop up on the right
        rrb.Vertical(
            rrb.TextDocumentView(origin="about", name="what one sees"),
            *_plots(learners[:1], watched, published),
            row_shares=[6, 4, 4],
        ),
        # on the arm's side of the workspace, to have all of the arm in view
        _scene("the arm", [learners[0], "damaged", "nominal", "target"], workspace, 0.75),
        column_shares=[3, 5],
        name="the arm before and after",
    )
    side_by_side = rrb.Vertical(
        rrb.Horizontal(*(_scene(learner, [learner], workspace, 1.0) for learner in learners)),
        rrb.Horizontal(*_plots(learners, watched, published)),
        row_shares=[5, 3],
        name=" and ".join(learners),
    )
    return rrb.Blueprint(
        rrb.Tabs(*([arm, side_by_side] if len(learners) > 1 else [arm]), active_tab=0),
        rrb.TimePanel(state="collapsed", timeline="time", play_state="paused", loop_mode="off"),
        rrb.BlueprintPanel(state="hidden"),
        rrb.SelectionPanel(state="hidden"),
    )


def _scene(
    name: str, entities: Iterable[str], workspace: Workspace, share: float
) -> rrb.Spatial3DView:
    """A view from before and the right of the arm.

    It looks at a point this share of the way to the workspace's centre.
    """
    centre = workspace.centre[:3, 3]
    far, up = np.linalg.norm(centre), np.array([0, 0, 1])
    forwards = np.array([centre[0], centre[1], 0]) / np.hypot(centre[0], centre[1])
    target = share * centre + 0.12 * far * up
    eye = target + far * (0.95 * forwards + 1.2 * np.cross(forwards, up) + 0.5 * up)
    return rrb.Spatial3DView(
        origin="/",
        contents=["/workspace/**", "/desired/**", *(f"/{entity}/**" for entity in entities)],
        name=name,
        background=(24, 28, 36),
        eye_controls=rrb.EyeControls3D(position=eye, look_target=target, eye_up=up),
    )


def _plots(
    learners: list[str], watched: Mapping[str, Watched], published: Mapping[str, float]
) -> Iterable[rrb.TimeSeriesView]:
    for quantity, title in TITLES.items():
        errors = [watched[learner].history.columns()[quantity] for learner in learners]
        line = [published[quantity]] if quantity in published else []
        values = logarithm(np.concatenate([*errors, line]))
        yield rrb.TimeSeriesView(
            origin=f"log10/{quantity}",
            contents=[f"$origin/{series}" for series in (PUBLISHED, *learners)],
            name=title,
            axis_y=rrb.ScalarAxis(
                range=(np.floor(values.min()) - MARGIN, np.ceil(values.max()) + MARGIN)
            ),
            plot_legend=rrb.Corner2D.RightTop,
        )
