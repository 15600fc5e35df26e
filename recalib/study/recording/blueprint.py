"""How the viewer arranges a recording when it opens."""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
import rerun.blueprint as rrb

from recalib.nominal.poses import Workspace
from recalib.study.plan.competitors import label_of
from recalib.study.recording.measurements import PUBLISHED
from recalib.study.recording.phases import ARM
from recalib.study.recording.watched import Watched

TITLES = {
    "position_error_cm": "mean position error [cm]",
    "orientation_error_deg": "mean orientation error [degrees]",
}
LEAST = 0.1  # cm and degrees, to which a plot reaches at least
BACKGROUND = 24, 28, 36


def arrange(
    watched: Mapping[str, Watched],
    workspace: Workspace,
    published: Mapping[str, float],
    side_by_side: bool,
) -> rrb.Blueprint:
    """Tabs: the arm with the first learner, and all learners side by side where there are several.

    Args:
        watched: by learner.
        published: initial errors, where there are any.
        side_by_side: which of the tabs is open.
    """
    learners, main = list(watched), next(iter(watched.values()))
    eye = seen_from(workspace, (main.achieved[0] - main.desired)[:, :3, 3])
    arm = rrb.Horizontal(
        # the text on the left, because the viewer's notices pop up on the right
        rrb.Vertical(
            rrb.TextDocumentView(origin="about", name="what one sees"),
            *_plots(learners[:1], watched, published),
            row_shares=[12, 8, 8],
        ),
        _scene(ARM, learners[0], workspace, eye),
        column_shares=[3, 5],
        name="the arm before and after",
    )
    beside = rrb.Vertical(
        rrb.Horizontal(*(_scene(label_of(name), name, workspace, eye) for name in learners)),
        rrb.Horizontal(
            rrb.TextDocumentView(origin="beside", name="what one sees"),
            *_plots(learners, watched, published),
        ),
        row_shares=[5, 3],
        name=" and ".join(map(label_of, learners)),
    )
    several = len(learners) > 1
    return rrb.Blueprint(
        rrb.Tabs(*([arm, beside] if several else [arm]), active_tab=int(several and side_by_side)),
        rrb.TimePanel(state="collapsed", timeline="time", play_state="playing", loop_mode="all"),
        rrb.BlueprintPanel(state="hidden"),
        rrb.SelectionPanel(state="hidden"),
    )


def seen_from(workspace: Workspace, misses: np.ndarray) -> np.ndarray:
    """Unit vector (3,) towards the eye: before the arm, on the side where misses look longest.

    Args:
        misses: (n, 3) m.
    """
    ahead = np.array([*workspace.centre[:2, 3], 0]) / np.hypot(*workspace.centre[:2, 3])
    up = np.array([0, 0, 1])
    aside = np.cross(ahead, up)
    eyes = [0.95 * ahead + side * 1.2 * aside + 0.5 * up for side in (1, -1)]
    eyes = [eye / np.linalg.norm(eye) for eye in eyes]
    return max(eyes, key=lambda eye: np.linalg.norm(np.cross(misses, eye), axis=-1).sum())


def _scene(name: str, learner: str, workspace: Workspace, eye: np.ndarray) -> rrb.Spatial3DView:
    """A view of a learner's arm, from this direction (3,)."""
    centre = workspace.centre[:3, 3]
    far, up = np.linalg.norm(centre), np.array([0, 0, 1])
    # on the arm's side of the workspace, to have all of the arm in view
    target = 0.68 * centre + 0.12 * far * up
    return rrb.Spatial3DView(
        origin="/",
        contents=["/workspace/**", "/desired/**", f"/{learner}/**"],
        name=name,
        background=BACKGROUND,
        eye_controls=rrb.EyeControls3D(
            position=target + 1.6 * far * eye, look_target=target, eye_up=up
        ),
    )


def _plots(
    learners: Sequence[str], watched: Mapping[str, Watched], published: Mapping[str, float]
) -> Iterable[rrb.TimeSeriesView]:
    for quantity, title in TITLES.items():
        errors = [watched[learner].history.columns()[quantity].max() for learner in learners]
        top = _end(max(*errors, published.get(quantity, 0), LEAST))
        yield rrb.TimeSeriesView(
            origin=f"errors/{quantity}",
            contents=[f"$origin/{series}" for series in (PUBLISHED, *learners)],
            name=title,
            axis_y=rrb.ScalarAxis(range=(-0.02 * top, top)),
            plot_legend=rrb.Corner2D.RightTop,
        )


def _end(largest: float) -> float:
    """Where an axis ends: a power of ten is in sight, as the viewer may label no other number."""
    power = 10 ** np.ceil(np.log10(largest))
    return 1.05 * power if largest > power / 2 else 1.1 * largest
