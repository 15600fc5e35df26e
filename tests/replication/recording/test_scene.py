"""What a recording shows is what was measured, where it was."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from scipy.spatial.transform import Rotation

from recalib import apply, position_error
from replication.config import damages_among
from replication.recording import (
    BEFORE,
    FRAMES_A_SECOND,
    POSES,
    VISIT,
    colours,
    move,
    sight_of,
    typical_seed,
    visiting_order,
)
from replication.training import ERRORS, Stream
from tests.replication.recording.conftest import ITERATIONS, OWN, TESTS

VISITS = POSES * VISIT  # frames
close = pytest.approx


@pytest.fixture(scope="module")
def seed(files) -> int:
    return typical_seed(pd.read_parquet(files.histories[0]))


@pytest.fixture(scope="module")
def poses(small, seed):
    """What is learned from, and what is tested on."""
    return Stream.SCENARIO.draw(small.seed, [seed], ITERATIONS, TESTS, scenario=OWN)


@pytest.fixture(scope="module")
def goals(robot, poses) -> np.ndarray:
    """The desired poses (pose, 4, 4) that are shown."""
    return robot.workspace.to_poses(visiting_order(poses.tests[0, :POSES]))


def placements(columns, entity) -> np.ndarray:
    """Those (frame, 4, 4) of a frame."""
    _, positions = columns(entity, "Transform3D:translation")
    _, quaternions = columns(entity, "Transform3D:quaternion")
    found = np.tile(np.eye(4), (len(positions), 1, 1))
    found[:, :3, 3] = np.reshape(positions, (-1, 3))
    found[:, :3, :3] = Rotation.from_quat(np.reshape(quaternions, (-1, 4))).as_matrix()
    return found


def test_errors_are_those_of_the_history(columns, files, seed):
    history = pd.read_parquet(files.histories[0]).query(f"seed == {seed}")
    for quantity in ERRORS:
        iterations, values = columns(f"/errors/{quantity}/improved", "Scalars:scalars")
        assert iterations == [-VISITS, *history["iteration"], ITERATIONS + VISITS]
        measured = history[quantity].iloc[[0, *range(len(history)), -1]]
        assert np.ravel(values) == close(measured.to_numpy(), rel=1e-9)
        assert columns(f"/errors/{quantity}/improved", "SeriesLines:colors")[0] is None


def test_both_arms_move_as_their_kinematics_say(columns, robot, resolved):
    """In the first frame both are at home; in every frame the tool is at the end of its link."""
    damaged = apply(robot, damages_among(resolved.damages))
    _, bones = columns("/improved/nominal/bones", "LineStrips3D:strips")
    bones = np.reshape(bones, (-1, 8, 3))
    _, joints = columns("/improved/nominal/joints", "Points3D:positions")
    assert np.allclose(joints, bones)
    wrist = placements(columns, "/improved/links/wrist_3_link")
    offset = robot.arm.model.frames[robot.arm.model.getFrameId("tool0")].placement.homogeneous
    tools = placements(columns, "/improved/links/tool")
    assert np.allclose(wrist @ offset, tools, atol=1e-5)
    assert np.allclose(bones[0], robot.arm.skeleton(robot.home[None])[0], atol=1e-6)
    assert np.allclose(tools[0], damaged.forward(robot.home[None])[0], atol=1e-5)


def test_the_nominal_arm_goes_where_it_is_sent_and_the_real_one_misses(
    columns, robot, resolved, goals
):
    """At rest at each pose before learning the skeleton is at the desired pose."""
    rests = np.arange(VISIT - 1, VISITS, VISIT)
    _, bones = columns("/improved/nominal/bones", "LineStrips3D:strips")
    assert np.allclose(np.reshape(bones, (-1, 8, 3))[rests, -1], goals[:, :3, 3], atol=1e-6)
    assert np.allclose(placements(columns, "/improved/links/nominal/tool")[rests], goals, atol=1e-5)
    desired = placements(columns, "/improved/links/target/pose")
    assert np.allclose(desired, np.concatenate([goals, goals]), atol=1e-5)
    controller = resolved.controller()
    landed = resolved.arm(robot).forward(controller.inverse(goals))
    tools = placements(columns, "/improved/links/tool")
    assert np.allclose(tools[rests], landed, atol=1e-5)
    after = tools[rests - VISITS]
    assert position_error(after, goals).mean() < 0.2 * position_error(landed, goals).mean()
    _, misses = columns("/improved/map/miss", "LineStrips3D:strips")
    for row, reached in ((0, landed), (-1, after)):
        ends = np.stack([goals[:, :3, 3], reached[:, :3, 3]], axis=1)
        assert np.allclose(misses[row], ends, atol=1e-5)


def test_the_tool_goes_on_from_the_arm_and_fits_into_the_desired_pose(columns, robot):
    (_, inmost), (tool, inside), (desired, outside) = (
        [
            np.array(columns(f"/improved/{part}", f"Boxes3D:{key}")[1][0])
            for key in ("centers", "half_sizes")
        ]
        for part in ("nominal/tool", "tool", "target/pose")
    )
    assert (tool @ robot.outward > 0).all() and (tool == desired).all()
    assert (inmost > 0).all() and (inmost < inside).all() and (inside < outside).all()


def test_damaged_links_joints_and_base_are_yellow(columns):
    """A shortened forearm, a shifted elbow, a sagging shoulder, and a base 2.2 cm off."""
    yellow = int.from_bytes([*colours.DAMAGE, 255], "big")
    for joint, link in (("elbow_joint", "forearm_link"), ("shoulder_lift_joint", "upper_arm_link")):
        entity = f"/improved/damage/{joint}"
        assert columns(entity, "CoordinateFrame:frame")[1][0] == [f"improved/{link}"]
        assert columns(entity, "LineStrips3D:colors")[1][0] == [yellow]
        (axis,) = columns(entity, "LineStrips3D:strips")[1][0]
        direction = np.subtract(axis[1], axis[0])
        assert abs(direction[1]) == close(np.linalg.norm(direction)), "both turn about y"
    mesh = "/improved/ur10/visual_geometries/forearm_link/visual_0"
    assert columns(mesh, "Asset3D:albedo_factor")[1][0] == [yellow]
    labels, shades = (columns("/legend", f"Points3D:{key}")[1][0] for key in ("labels", "colors"))
    assert shades[labels.index("damage")] == yellow
    (circle,) = columns("/improved/damage/base", "LineStrips3D:strips")[1][0]
    assert np.mean(circle[:-1], axis=0) == close([0.01, 0, -0.02], abs=1e-6)


def test_the_map_starts_without_corrections_and_lights_up_at_its_winner(columns, robot, poses):
    _, arrows = columns("/improved/map/corrections", "Arrows3D:vectors")
    assert np.ptp(arrows[0]) == 0
    _, misses = columns("/improved/map/miss", "LineStrips3D:strips")
    miss = np.diff(np.array(misses[0]), axis=1).mean(axis=(0, 1))
    made_up_for = -np.mean(arrows[-1], axis=0) @ miss
    assert made_up_for > 0.5 * miss @ miss
    (centres,) = columns("/improved/map/cells", "Points3D:positions")[1]
    last = robot.workspace.to_poses(poses.desired[0, -1])[:3, 3]
    _, radii = columns("/improved/map/cells", "Points3D:radii")
    assert np.argmax(radii[-1]) == np.linalg.norm(np.subtract(centres, last), axis=-1).argmin()
    assert np.max(radii[0]) == np.min(radii) > 0, "none has won yet"


def test_the_arm_moves_smoothly_and_rests_at_every_pose(robot):
    random = np.random.default_rng(1)
    angles = robot.home + random.uniform(-0.4, 0.4, (3, POSES, 6))
    motion = move(angles, np.array([0, 4, 8]), robot.home)
    first, last = motion.angles[:VISITS], motion.angles[-VISITS:]
    for moved, stops in ((first, angles[0]), (last, angles[-1])):
        a_second = FRAMES_A_SECOND * np.abs(np.diff(moved, axis=0))
        assert a_second.max() < 2 * np.pi, "never more than one turn a second"
        assert np.allclose(moved.reshape(len(stops), -1, 6)[:, -1], stops)
    assert (np.diff(motion.frames) > 0).all()
    assert (np.diff(motion.departures.ravel()) >= VISIT).all()
    waiting = motion.frames.tolist().index(BEFORE)
    assert np.allclose(motion.angles[waiting], angles[0, -1])


def in_picture(sight, points) -> np.ndarray:
    """Where in the picture points (..., 3) [m] are: (..., 2) aside and above."""
    right, up = sight.axes / np.square(sight.axes[0]).sum()
    ahead = (sight.target - sight.eye) / np.square(sight.target - sight.eye).sum()
    depth = (points - sight.eye) @ ahead
    return (points - sight.target) @ np.stack([right, up], axis=1) / depth[..., None]


def test_the_eye_is_on_the_side_from_which_misses_look_longest(robot):
    misses = np.array([(5, -5, 4.3), (5, 5, 4.3)])
    sights = [sight_of(robot.workspace, miss[None]) for miss in misses]
    eyes = [sight.eye - sight.target for sight in sights]
    assert eyes[0][1] > 0 > eyes[1][1]
    for miss, eye in zip(misses, eyes, strict=True):
        across = np.linalg.norm(np.cross(miss, eye))
        assert across > 0.9 * np.linalg.norm(miss) * np.linalg.norm(eye)
    far = np.diag([2.0, 2.0, 2.0, 1.0]) @ robot.workspace.centre @ np.diag([0.5, 0.5, 0.5, 1.0])
    twice = sight_of(replace(robot.workspace, centre=far), misses[:1])
    assert np.allclose(twice.eye, 2 * sights[0].eye), "all of an arm twice as large is in view"
    for sight in sights:
        assert in_picture(sight, np.zeros(3))[0] > 0, "the base is aside"
        assert np.allclose(in_picture(sight, sight.place(0.3, -0.8)), [0.3, -0.8])
