"""What a recording shows is what was measured, where it was."""

from itertools import permutations
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from recalib.damaged.damage import EncoderShift, apply
from recalib.damaged.plant import Plant
from recalib.learners.polynomial import PolynomialLearner
from recalib.nominal.controller import Controller
from recalib.nominal.poses import position_error
from replication.training.measured import ERRORS
from replication.recording import labels, markers, measurements, scene
from replication.recording.blueprint import TITLES, _plots
from replication.recording.phases import BEFORE, FRAMES_A_SECOND, POSES, VISIT, move
from replication.recording.sight import sight_of
from replication.recording.watched import REPEATED, visiting_order, watch
from replication.training.poses import Stream
from tests.arms import panda
from tests.replication.recording.conftest import DAMAGES, ITERATIONS, SEED, poses

VISITS = POSES * VISIT  # frames


def motion_of(training, robot):
    return move(training.angles, training.history.iterations, robot.home, ITERATIONS)


def test_errors_are_those_of_the_experiment_beside_the_published_ones(job, columns, results):
    for name, frame in results.items():
        for quantity in ERRORS:
            iterations, values = columns(f"/errors/{quantity}/{name}", "Scalars:scalars")
            assert iterations == [-VISITS, *frame["iteration"], ITERATIONS + VISITS]
            measured = frame[quantity].iloc[[0, *range(len(frame)), -1]]
            assert np.ravel(values).tolist() == measured.tolist()
    for quantity, value in job.published.items():
        _, line = columns(f"/errors/{quantity}/paper", "Scalars:scalars")
        assert np.allclose(np.ravel(line), value)


def test_landings_are_where_the_damaged_arm_lands(resolved, controller, recording, columns):
    """Before learning: it is sent to the desired poses themselves."""
    shown = visiting_order(poses().tests[0, :POSES])
    goals = controller.robot.workspace.to_poses(shown)
    (landed,), _ = resolved(DAMAGES).plant(controller, SEED, [0]).achieve(shown[None])
    training = recording[1]["improved"]
    assert np.allclose(training.achieved[0], landed) and np.allclose(training.desired, goals)
    _, axes = columns("/improved/achieved", "LineStrips3D:strips")
    _, misses = columns("/improved/miss", "LineStrips3D:strips")
    _, (frames,) = columns("/desired", "LineStrips3D:strips")
    length = scene.AXIS * scene.unit_of(controller.robot.workspace)
    for drawn, placements in (
        (frames, goals),
        (axes[0], landed),
        (axes[-1], training.achieved[-1]),
    ):
        tips = np.reshape(drawn, (-1, 3, 2, 3))[:, :, 1].swapaxes(1, 2)
        expected = placements[:, :3, 3:] + length * placements[:, :3, :3]
        assert np.allclose(tips, expected, atol=1e-6)
    for row in (0, -1):
        ends = np.stack([goals[:, :3, 3], training.achieved[row, :, :3, 3]], axis=1)
        assert np.allclose(misses[row], ends, atol=1e-6)
    for part, most in (("miss", 0.03), ("achieved", 0.01)):
        _, radii = columns(f"/improved/{part}", "LineStrips3D:radii")
        assert np.max(radii) == pytest.approx(most * scene.unit_of(controller.robot.workspace))
        assert np.mean(radii[-1]) < 0.5 * np.mean(radii[0]), "what is hit is not in sight"
    missed = position_error(training.achieved, training.desired).mean(axis=1)
    assert missed[-1] < 0.2 * missed[0]


@pytest.mark.parametrize("name", ["improved", "ritter"])
def test_each_arm_ends_where_it_lands_and_its_skeleton_where_it_was_sent(
    robot, recording, columns, name
):
    training = recording[1][name]
    tool = robot.arm.model.frames[robot.arm.model.getFrameId("tool0")].placement
    achieved = training.achieved[-1, -1]  # in the last row: at rest at the last pose, trained
    _, positions = columns(f"/{name}/links/wrist_3_link", "Transform3D:translation")
    _, quaternions = columns(f"/{name}/links/wrist_3_link", "Transform3D:quaternion")
    turn = Rotation.from_quat(quaternions[-1][0]).as_matrix()
    assert np.allclose(positions[-1][0] + turn @ tool.translation, achieved[:3, 3], atol=1e-6)
    assert np.allclose(turn @ tool.rotation, achieved[:3, :3], atol=1e-6)
    _, bones = columns(f"/{name}/believed/bones", "LineStrips3D:strips")
    _, joints = columns(f"/{name}/believed/joints", "Points3D:positions")
    sent = robot.arm.forward(training.angles[-1, -1:])[0, :3, 3]
    assert np.allclose(bones[-1][0][-1], sent, atol=1e-6)
    assert np.allclose(joints[-1], bones[-1][0]) and len(joints[-1]) == 8
    assert len(positions) == len(bones) == len(motion_of(training, robot).frames)


def test_what_is_wrong_is_marked_and_labelled_at_its_link_and_joint(robot, recording, columns):
    unit = scene.unit_of(robot.workspace)
    found = markers.markers(robot, (*DAMAGES[:-1], EncoderShift("elbow_joint", 0.01)), unit)
    words = [
        ("forearm_link", "forearm: 4 cm short"),
        ("forearm_link", "elbow: encoder -4 deg, encoder 0.01 rad"),
        ("upper_arm_link", "shoulder lift: sag 0.0002 rad/Nm"),
    ]
    assert [(marker.link, marker.words) for marker in found] == words
    short, elbow, shoulder = found
    assert short.axis is None and np.linalg.norm(short.at) == pytest.approx(0.5723 / 2, abs=1e-3)
    # the shoulder lifts and the elbow bends about the y axis of their links
    for marker in (elbow, shoulder):
        assert np.allclose(np.diff(marker.axis, axis=0), [0, 2 * markers.HALF_AXIS * unit, 0])
    for number, marker in enumerate(found[1:], 1):
        (frame,) = columns(f"/improved/wrong/{number}/axis", "CoordinateFrame:frame")[1]
        assert frame == [f"improved/{marker.link}"]
    labels = [columns(f"/improved/wrong/{label}/label", "Points3D:labels")[1] for label in range(4)]
    assert labels == [
        [["forearm: 4 cm short"]],
        [["elbow: encoder -4 deg"]],
        [["shoulder lift: sag 0.0002 rad/Nm"]],
        [["base: 2.2 cm off"]],
    ]


@pytest.mark.parametrize("side", [-1, 1])
def test_leaders_cross_neither_one_another_nor_the_words_of_another_label(side):
    """A start above all labels and beyond their inner side, and others towards the middle."""
    starts = side * np.array([[0.55, -0.2], [0.95, -0.3], [0.2, -0.7], [0.4, -0.4]])
    half, lines = 0.3, []
    order = labels.in_order(side, starts)
    for place, label in enumerate(order):
        at = side * np.array([labels.ASIDE, labels.GAP * place - labels.ABOVE])
        free = place == len(order) - 1
        lines.append((starts[label], labels.leader_end(side, at, half, starts[label], free), at))
    along = np.linspace(0, 1, 500)[:, None]
    points = [start + along * (end - start) for start, end, _ in lines]
    for one, other in permutations(range(len(lines)), 2):
        apart = np.linalg.norm(points[one][:, None] - points[other], axis=-1)
        assert apart.min() > 0.01, "leaders"
        inside = np.abs(points[one] - lines[other][2] + [0, labels.LINE]) < [half, labels.LINE / 2]
        assert not inside.all(axis=1).any(), "words"
    at, far = np.array([side * labels.ASIDE, 0.0]), np.array([side * 2.0, 0.5])
    beyond = side * (labels.ASIDE + 0.5)
    assert labels.leader_end(side, at, 0.5, far, True)[0] == pytest.approx(beyond), "its outer end"


def test_measurements_scatter_about_the_landings_and_are_enlarged_to_be_visible(recording, columns):
    training = recording[1]["improved"]
    assert training.scatter.shape == (POSES, REPEATED, 3)
    assert training.scatter.std() == pytest.approx(0.0002, rel=0.2)  # of 360 numbers
    assert measurements.enlarged(training) == 100
    _, lines = columns("/improved/measured", "LineStrips3D:strips")
    starts, ends = np.reshape(lines[-1], (POSES, REPEATED, 2, 3)).swapaxes(0, 2)
    landed = training.achieved[-1, :, :3, 3]
    assert np.allclose(starts, landed, atol=1e-6)
    assert np.allclose(ends - starts, 100 * training.scatter.swapaxes(0, 1), atol=1e-5)


def test_the_map_starts_without_corrections_and_lights_up_at_its_winner(
    controller, recording, columns
):
    training = recording[1]["improved"]
    _, arrows = columns("/improved/map/corrections", "Arrows3D:vectors")
    assert np.ptp(arrows[0]) == 0
    assert np.allclose(arrows[-1], training.cells.corrections[-1], atol=1e-6)
    misses = (training.achieved[0] - training.desired)[:, :3, 3].mean(axis=0)
    made_up_for = -np.mean(arrows[-1], axis=0) @ misses
    assert made_up_for > 0.5 * misses @ misses
    last = controller.robot.workspace.to_poses(poses().desired[0, -1])[:3, 3]
    winner = np.linalg.norm(training.cells.centres - last, axis=-1).argmin()
    weights = training.cells.weights
    assert weights[-1].argmax() == winner and weights[-1, winner] == 1
    assert not weights[0].any()


def test_the_arm_moves_smoothly_and_rests_at_every_pose(robot, recording):
    training = recording[1]["improved"]
    motion = motion_of(training, robot)
    for angles, stops in (
        (motion.angles[:VISITS], training.angles[0]),
        (motion.angles[-VISITS:], training.angles[-1]),
    ):
        a_second = FRAMES_A_SECOND * np.abs(np.diff(angles, axis=0))
        assert a_second.max() < 2 * np.pi, "never more than one turn a second"
        assert np.allclose(angles.reshape(len(stops), -1, 6)[:, -1], stops)
    assert (np.diff(motion.frames) > 0).all()
    assert (np.diff(motion.departures.ravel()) >= VISIT).all()
    waiting = motion.frames.tolist().index(BEFORE)
    assert np.allclose(motion.angles[waiting], training.angles[0, -1])


def test_an_arm_of_seven_joints_is_watched_and_moved():
    robot = panda()
    damaged, controller = apply(robot, [EncoderShift("panda_joint3", 0.05)]), Controller(robot)
    its = Stream.REPLAY.draw(1, [0], 5, 15)
    plant = Plant(controller, damaged, None, [np.random.default_rng(2)])
    watched = watch(controller, plant, PolynomialLearner(1), its, [0, 5])
    reached = damaged.forward(watched.angles[-1])
    np.testing.assert_allclose(reached, watched.achieved[-1], rtol=0, atol=1e-12)
    motion = motion_of(watched, robot)
    assert np.allclose(motion.angles[-1], watched.angles[-1, -1])
    bones = robot.arm.skeleton(motion.angles[-1:])
    assert bones.shape == (1, 9, 3)  # base, seven joints, tool


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
        assert np.linalg.norm(np.cross(miss, eye)) > 0.9 * np.linalg.norm(miss) * np.linalg.norm(
            eye
        )
    for sight in sights:
        assert in_picture(sight, np.zeros(3))[0] > 0, "the base is aside"
        place = [0.3, -0.8]
        assert np.allclose(in_picture(sight, sight.place(*place)), place)
        assert np.allclose(sight.projected(sight.place(*place)), place)


def test_plots_reach_to_the_last_iteration_of_the_longest_training():
    def trained(iterations):
        columns = dict.fromkeys(TITLES, np.array([1.0, 0.5]))
        history = SimpleNamespace(iterations=np.array([0, iterations]), columns=columns.copy)
        return SimpleNamespace(history=history)

    views = _plots(["long", "short"], {"long": trained(200), "short": trained(50)}, {})
    for view in views:
        (shown,) = view.properties["TimeAxis"].view_range.as_arrow_array().to_pylist()
        assert [shown["start"], shown["end"]] == [0, 220], "with room for the number of the last"


def test_a_plot_of_no_error_reaches_as_far_as_one_can_read():
    nothing = dict.fromkeys(TITLES, np.zeros(2))
    history = SimpleNamespace(iterations=np.array([0, 200]), columns=nothing.copy)
    for view in _plots(["intact"], {"intact": SimpleNamespace(history=history)}, {}):
        (ends,) = view.properties["ScalarAxis"].range.as_arrow_array().to_pylist()
        assert ends[1] >= 0.1
