"""The entities of a recording. Constant ones are static; others are sent as columns over time.

    /about                         the text
    /legend                        the meaning of the colours
    /<learner>/<robot>             the meshes of the real arm
    /<learner>/links               poses of its links and of all grippers
    /<learner>/tool                its gripper
    /<learner>/nominal             the arm that its controller assumes, as a skeleton with a gripper
    /<learner>/damage              axes of damaged joints, the base if it was displaced
    /<learner>/target              the desired pose, and a caption
    /<learner>/map/workspace       the box of positions
    /<learner>/map/desired         positions of the shown test poses
    /<learner>/map/miss            lines from there to the achieved positions
    /<learner>/map/cells           the supernet's cells, sized by the last winner's neighbourhood
    /<learner>/map/corrections     learned change of each cell's position command
    /errors/<quantity>/<learner>   mean errors over all test poses

Timeline `iterations` runs through the three phases of `phases.Motion`.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import rerun as rr
from scipy.spatial.transform import Rotation

from recalib.laboratory.logged_arm import send_frame
from recalib.nominal.robots import Robot
from recalib.nominal.workspace import POSITION
from replication.recording.blueprint import Sight
from replication.recording.colours import GREY, NOMINAL, REACHED, WHITE, Colour
from replication.recording.phases import CLOCK, Clock, Motion
from replication.recording.watched import Watched
from replication.training.measured import ERRORS

# in units of half the picture's height
TOP = 0.98  # height of the caption
LEGEND = 1.0, -0.36  # place of the legend's first line (towards the base, up): below the base
LINE = 0.14
# A gripper shows a pose. Centres of its stem, bar and fingers, outwards from the arm and across,
# and half their sizes without their thickness, in units of `Scene.unit`.
CENTRES = np.array([(0.12, 0, 0), (0.24, 0, 0), (0.42, 0.18, 0), (0.42, -0.18, 0)])
HALVES = np.array([(0.12, 0, 0), (0, 0.18, 0), (0.18, 0, 0), (0.18, 0, 0)])
EDGE = 0.012  # radius of an outline's lines


class Gripper(NamedTuple):
    """The style of a gripper."""

    half: float  # half its thickness, in units of `Scene.unit`
    colour: Colour
    fill: rr.components.FillMode  # solid, or edges only


# Each gripper fits into the one before.
OUTLINE = Gripper(0.05, WHITE, rr.components.FillMode.MajorWireframe)
REAL = Gripper(0.035, REACHED, rr.components.FillMode.Solid)
ASSUMED = Gripper(0.03, NOMINAL, rr.components.FillMode.Solid)


@dataclass(frozen=True)
class Scene:
    """A learner's training for a recording; its entities are below one with the learner's name."""

    rec: rr.RecordingStream
    learner: str
    robot: Robot
    watched: Watched
    motion: Motion
    sight: Sight

    @property
    def unit(self) -> float:
        """Unit of size of all drawn objects [m]: half a side of the workspace, on average."""
        return float(self.robot.workspace.half_ranges[POSITION].mean())

    def log(self, part: str, *what: rr.AsComponents) -> None:
        """Log static data."""
        self.rec.log(f"{self.learner}/{part}", *what, static=True)

    def send(self, part: str, clock: Clock, columns: rr.ComponentColumnList, each: int = 1) -> None:
        """Send columns over time, with `each` rows at each moment."""
        moments = len(clock[0].as_arrow_array())
        self.rec.send_columns(f"{self.learner}/{part}", clock, columns.partition([each] * moments))

    def show(
        self, part: str, columns: rr.ComponentColumnList, each: int, style: rr.AsComponents
    ) -> None:
        """Send columns at all measurements, with `each` rows at each, and a static style."""
        self.send(part, self.motion.measurements()[0], columns, each)
        self.log(part, style)


def log_surroundings(scene: Scene, description: str, legend: Mapping[str, Colour]) -> None:
    """Log the texts and, for the map, the workspace's box and the desired positions.

    The legend is in the corner below the base, each line in its own colour.
    """
    rec, workspace, unit = scene.rec, scene.robot.workspace, scene.unit
    aside, above = LEGEND
    places = [scene.sight.place(aside, above - LINE * number) for number in range(len(legend))]
    lines = rr.Points3D(places, radii=0, colors=[*legend.values()], labels=[*legend])
    rec.log("legend", lines, static=True)
    rec.log("/", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
    rec.log("about", rr.TextDocument(description, media_type="text/markdown"), static=True)
    box = rr.Boxes3D(
        centers=[workspace.centre[:3, 3]],
        half_sizes=[workspace.half_ranges[POSITION]],
        colors=GREY,
        radii=0.004 * unit,
        fill_mode=rr.components.FillMode.MajorWireframe,
    )
    scene.log("map/workspace", box)
    positions = scene.watched.desired[:, :3, 3]
    scene.log("map/desired", rr.Points3D(positions, colors=WHITE, radii=OUTLINE.half * unit))


def send_target(scene: Scene, captions: Sequence[str]) -> None:
    """Send the desired pose over time, and a caption for each measurement at the top."""
    motion = scene.motion
    clock, rows = motion.measurements()
    top = scene.sight.place(0, TOP)
    scene.log("target/caption", rr.Points3D([top], radii=0, colors=WHITE))
    scene.send("target/caption", clock, rr.Points3D.columns(labels=[captions[row] for row in rows]))
    visited = np.tile(scene.watched.desired, (2, 1, 1))
    departures = [rr.TimeColumn(CLOCK, sequence=motion.departures.ravel())]
    send_gripper(scene, "target/pose", departures, visited, OUTLINE)


def send_gripper(
    scene: Scene, part: str, clock: Clock, poses: np.ndarray, gripper: Gripper
) -> None:
    """Send a gripper at poses (n, 4, 4) [m] over time."""
    frame = f"{scene.learner}/{part}"
    send_frame(scene.rec, f"{scene.learner}/links/{part}", frame, clock, poses)
    turn, _ = Rotation.align_vectors(scene.robot.outward, (1, 0, 0))
    boxes = rr.Boxes3D(
        centers=scene.unit * turn.apply(CENTRES),
        half_sizes=scene.unit * (HALVES + gripper.half),
        quaternions=np.tile(turn.as_quat(), (len(CENTRES), 1)),
        colors=gripper.colour,
        radii=EDGE * scene.unit,
        fill_mode=gripper.fill,
    )
    scene.log(part, boxes, rr.CoordinateFrame(frame))


def send_learning(scene: Scene) -> None:
    """Send what each measurement shows: mean errors, errors of the shown poses, and the map.

    Errors of positions are lines from the desired to the achieved ones. The supernet's cells are
    sized by how much they learned last; their corrections are drawn to scale.
    """
    watched, unit, (clock, rows) = scene.watched, scene.unit, scene.motion.measurements()
    results = watched.history.columns()
    # show all numbers: the viewer would otherwise average them
    style = rr.SeriesLines(names=scene.learner, colors=NOMINAL, widths=3, aggregation_policy="off")
    for quantity in ERRORS:
        entity = f"errors/{quantity}/{scene.learner}"
        scene.rec.send_columns(entity, clock, rr.Scalars.columns(scalars=results[quantity][rows]))
        scene.rec.log(entity, style, static=True)
    achieved = watched.achieved[rows][..., :3, 3]
    desired = np.broadcast_to(watched.desired[:, :3, 3], achieved.shape)
    misses = np.stack([desired, achieved], axis=2).reshape(-1, 2, 3)
    line = rr.LineStrips3D.from_fields(colors=REACHED, radii=0.02 * unit)
    lines = rr.LineStrips3D.columns(strips=misses)
    scene.show("map/miss", lines, len(watched.desired), line)
    points = rr.Points3D.columns(radii=(0.022 + 0.038 * watched.weights[rows].ravel()) * unit)
    cell = rr.Points3D(watched.centres, colors=NOMINAL)
    scene.show("map/cells", points, len(watched.centres), cell)
    arrows = rr.Arrows3D.columns(vectors=watched.corrections[rows].reshape(-1, 3))
    arrow = rr.Arrows3D.from_fields(origins=watched.centres, radii=0.011 * unit, colors=NOMINAL)
    scene.show("map/corrections", arrows, len(watched.centres), arrow)
