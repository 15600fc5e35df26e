"""The entities of a recording: what stands still is static, the rest is sent as columns over time.

    /about                         the text
    /workspace, /desired           the box of positions, and the shown test poses in it
    /legend                        what the colours mean
    /<learner>/<robot>             the meshes of the real arm that the learner moves
    /<learner>/links               where its links are
    /<learner>/tool                the pose of its tool
    /<learner>/nominal             the arm that its controller assumes, as a skeleton
    /<learner>/damage              where the arm is not what its controller assumes
    /<learner>/target              the pose that the arm is sent to, and a caption
    /<learner>/reached             where the real arm lands
    /<learner>/miss                lines to there from the desired positions
    /<learner>/map/cells           the supernet's cells, lit by the neighbourhood of the last winner
    /<learner>/map/corrections     how far each cell has learned to move its position command
    /errors/<quantity>/<learner>   mean errors over all test poses

Timeline `iterations` runs through the three phases of `phases.Motion`.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import rerun as rr

from recalib.nominal.poses import POSITION, Workspace
from replication.recording.colours import GREY, WHITE, Colour
from replication.recording.phases import CLOCK, Clock, Motion
from replication.recording.sight import Sight
from replication.recording.watched import Watched

# of a picture whose half is 1 high
TOP = 0.98  # where the caption stands
LEGEND = 0.88, -0.44  # the first line of the legend, aside and above: below the base
LINE = 0.12
AXIS = 0.22  # length of the axes of a pose, in units of `unit_of`


@dataclass(frozen=True)
class Scene:
    """A learner's training on its way into a recording, below an entity of the learner's name."""

    rec: rr.RecordingStream
    learner: str
    workspace: Workspace
    watched: Watched
    motion: Motion
    sight: Sight

    def log(self, part: str, *what: rr.AsComponents) -> None:
        """Log what stands still."""
        self.rec.log(f"{self.learner}/{part}", *what, static=True)

    def send(self, part: str, clock: Clock, columns: rr.ComponentColumnList, each: int = 1) -> None:
        """Send columns over time, with so many rows at each moment."""
        moments = len(clock[0].as_arrow_array())
        self.rec.send_columns(f"{self.learner}/{part}", clock, columns.partition([each] * moments))

    def show(
        self, part: str, columns: rr.ComponentColumnList, each: int, style: rr.AsComponents
    ) -> None:
        """Send columns at all measurements, with so many rows at each, and what stands still."""
        self.send(part, self.motion.measurements()[0], columns, each)
        self.log(part, style)


def unit_of(workspace: Workspace) -> float:
    """m: half a side of the workspace, on average, by which everything drawn is sized."""
    return float(workspace.half_ranges[POSITION].mean())


def log_surroundings(
    rec: rr.RecordingStream, workspace: Workspace, desired: np.ndarray, description: str
) -> None:
    """The text, the workspace's box and the desired poses (pose, 4, 4)."""
    unit = unit_of(workspace)
    rec.log("/", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
    rec.log("about", rr.TextDocument(description, media_type="text/markdown"), static=True)
    box = rr.Boxes3D(
        centers=[workspace.centre[:3, 3]],
        half_sizes=[workspace.half_ranges[POSITION]],
        colors=GREY,
        radii=0.004 * unit,
        fill_mode=rr.components.FillMode.MajorWireframe,
    )
    rec.log("workspace", box, static=True)
    axes = rr.LineStrips3D(axes_of(desired, AXIS * unit), colors=WHITE, radii=0.013 * unit)
    rec.log("desired", axes, static=True)


def log_legend(rec: rr.RecordingStream, sight: Sight, lines: Mapping[str, Colour]) -> None:
    """What the colours mean, each line in its own, in the corner below the base."""
    aside, above = LEGEND
    places = [sight.place(aside, above - LINE * number) for number in range(len(lines))]
    legend = rr.Points3D(places, radii=0, colors=[*lines.values()], labels=[*lines])
    rec.log("legend", legend, static=True)


def send_target(scene: Scene, captions: Sequence[str]) -> None:
    """The pose that the arm is sent to, and above all a caption for each measurement."""
    motion = scene.motion
    clock, rows = motion.measurements()
    top = scene.sight.place(0, TOP)
    scene.log("target/caption", rr.Points3D([top], radii=0, colors=WHITE))
    scene.send("target/caption", clock, rr.Points3D.columns(labels=[captions[row] for row in rows]))
    dot = rr.Points3D.from_fields(radii=0.052 * unit_of(scene.workspace), colors=WHITE)
    scene.log("target/pose", dot)
    visited = np.tile(scene.watched.desired[:, :3, 3], (2, 1))
    departures = [rr.TimeColumn(CLOCK, sequence=motion.departures.ravel())]
    scene.send("target/pose", departures, rr.Points3D.columns(positions=visited))


def axes_of(poses: np.ndarray, length: float) -> np.ndarray:
    """The axes of poses (pose, 4, 4) as lines (pose x axis, 2, 3) of this length [m]."""
    origins = np.repeat(poses[:, None, :3, 3], 3, axis=1)
    tips = origins + length * np.swapaxes(poses[:, :3, :3], 1, 2)
    return np.stack([origins, tips], axis=2).reshape(-1, 2, 3)
