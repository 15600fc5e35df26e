"""The viewer's layout of a recording when it opens, its first view, and places of texts in it."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import rerun as rr
import rerun.blueprint as rrb

from recalib.nominal.workspace import Workspace
from replication.recording.colours import BACKGROUND
from replication.recording.phases import ARM, CLOCK, FRAMES_A_SECOND, MAP
from replication.recording.watched import Watched

TITLES = {
    "position_error_cm": "mean position error [cm] over iterations",
    "orientation_error_deg": "mean orientation error [degrees] over iterations",
}
LEAST = 0.1  # cm and degrees, the smallest range of a plot
HALF = np.tan(np.radians(55 / 2))  # half the height of the viewer's picture, at a distance of 1


@dataclass(frozen=True)
class Sight:
    """The first view of an arm and its workspace."""

    eye: np.ndarray  # (3,) m, position of the eye
    target: np.ndarray  # (3,) m, point in the middle of the picture
    axes: np.ndarray  # (2, 3) m, vectors of half the picture's height, towards the base and up

    def place(self, aside: float, above: float) -> np.ndarray:
        """A point (3,) [m] of the plane that faces the eye, by its place in the picture."""
        return self.target + [aside, above] @ self.axes


def sight_of(workspace: Workspace, misses: np.ndarray) -> Sight:
    """A view from in front of the arm, from the side on which errors (n, 3) [m] look longest."""
    centre = workspace.centre[:3, 3]
    ahead = np.array([*centre[:2], 0]) / np.hypot(*centre[:2])
    up = np.array([0, 0, 1])
    eyes = [0.95 * ahead + side * 1.2 * np.cross(ahead, up) + 0.5 * up for side in (1, -1)]
    eyes = [eye / np.linalg.norm(eye) for eye in eyes]
    eye = max(eyes, key=lambda eye: np.linalg.norm(np.cross(misses, eye), axis=-1).sum())
    aside = np.cross(up, eye)
    axes = np.array([-np.sign(aside @ ahead) * aside, np.cross(eye, aside)])
    away = 1.6 * np.linalg.norm(centre)
    # nearer to the arm than the workspace's centre, to have all of the arm in view
    target = 0.68 * centre + 0.075 * away * up
    half = away * HALF / np.linalg.norm(aside)
    return Sight(eye=target + away * eye, target=target, axes=half * axes)


def arrange(learner: str, watched: Watched, sight: Sight) -> rrb.Blueprint:
    """Text and errors to the left; to the right, tabs with the arm and with its map."""
    eye = rrb.EyeControls3D(position=sight.eye, look_target=sight.target, eye_up=(0, 0, 1))
    of_map, caption = f"/{learner}/map/**", f"/{learner}/target/caption"
    pictures = (
        rrb.Spatial3DView(contents=contents, name=name, background=BACKGROUND, eye_controls=eye)
        for name, contents in ((ARM, ["/**", f"- {of_map}"]), (MAP, [of_map, caption]))
    )
    # the text on the left, because the viewer's notices pop up on the right
    text = rrb.TextDocumentView(origin="about", name="what you see")
    left = rrb.Vertical(text, *_plots(watched), row_shares=[12, 8, 8])
    return rrb.Blueprint(
        rrb.Horizontal(
            left, rrb.Tabs(*pictures), column_shares=[3, 5], name="the arm before and after"
        ),
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


def _plots(watched: Watched) -> Iterable[rrb.TimeSeriesView]:
    # extended beyond the last iteration, to leave room for its label
    last = round(1.1 * watched.history.iterations[-1])
    bounds = (rrb.TimeRangeBoundary.absolute(seq=end) for end in (0, last))
    iterations = rrb.TimeAxis(view_range=rr.TimeRange(*bounds))
    for quantity, title in TITLES.items():
        top = _end(max(watched.history.columns()[quantity].max(), LEAST))
        yield rrb.TimeSeriesView(
            origin=f"errors/{quantity}",
            name=title,
            axis_x=iterations,
            axis_y=rrb.ScalarAxis(range=(-0.02 * top, top)),
            plot_legend=rrb.Corner2D.RightTop,
        )


def _end(largest: float) -> float:
    """The end of an axis. A power of ten is visible, because the viewer may label nothing else."""
    power = 10 ** np.ceil(np.log10(largest))
    return 1.05 * power if largest > power / 2 else 1.1 * largest
