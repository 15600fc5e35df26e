"""The arm in MuJoCo is the arm of Pinocchio, and droops as statics says."""

import numpy as np
import pytest

from recalib.damaged.damage import DamagedArm, EncoderShift, LinkShortening, apply
from recalib.errors import UnsuitableRobot
from recalib.nominal.arms import load_arm
from recalib.nominal.denavit_hartenberg import Row, arm_of_table
from recalib.nominal.poses import orientation_error, position_error
from recalib.nominal.robots import load_robot
from recalib.station.interface import Station, StationFailed

pytest.importorskip("mujoco", reason="of the extra live")
import simulated_arm as physics

Gears, PhysicsStation = physics.Gears, physics.PhysicsStation
pytestmark = pytest.mark.slow  # only slow tests and pages use this arm
ARMS = {"ur10": ("ur10_robot.urdf", "tool0"), "panda": ("panda.urdf", "panda_link8")}


def intact(name: str) -> DamagedArm:
    arm = load_arm(*ARMS[name])
    return DamagedArm(arm, np.zeros(arm.model.nv))


def bent() -> DamagedArm:
    home = dict.fromkeys(load_arm(*ARMS["ur10"]).joints, -1.0)
    robot = load_robot(*ARMS["ur10"], home, [0.1] * 3, [0.1] * 3)
    damages = LinkShortening("forearm_link", 0.04), EncoderShift("elbow_joint", 0.07)
    return apply(robot, damages)


def postures(damaged: DamagedArm, count: int) -> np.ndarray:
    """(count, joints) rad, within the limits."""
    model = damaged.arm.model
    low, high = model.lowerPositionLimit, model.upperPositionLimit
    return np.random.default_rng(0).uniform(
        np.maximum(low, -3), np.minimum(high, 3), (count, len(low))
    )


@pytest.mark.parametrize("damaged", [bent()], ids=["bent ur10"])
def test_without_gravity_it_stands_where_kinematics_says(damaged):
    damaged.arm.model.gravity.linear, joints = np.zeros(3), postures(damaged, 5)
    poses, expected = PhysicsStation(damaged).forward(joints), damaged.forward(joints)
    assert position_error(poses, expected).max() < 1e-6
    assert orientation_error(poses, expected).max() < 1e-6


@pytest.mark.parametrize("damaged", [bent(), intact("panda")], ids=["bent ur10", "panda"])
def test_joints_droop_by_their_torque_over_their_stiffness(damaged):
    joints, stiffness = postures(damaged, 5), np.linspace(2e4, 5e3, damaged.arm.model.nv)
    droop = (
        (PhysicsStation(damaged, Gears(stiffness)).forward(joints)[:, :3, 3])
        - damaged.forward(joints)[:, :3, 3]
    )
    standing = damaged.standing(joints)
    for _ in range(5):  # the torque is that where it stands
        standing = damaged.standing(joints) - damaged.arm.gravity_torque(standing) / stiffness
    expected = damaged.arm.forward(standing)[:, :3, 3] - damaged.forward(joints)[:, :3, 3]
    assert np.linalg.norm(expected, axis=1).max() > 2e-3
    assert (
        np.linalg.norm(droop - expected, axis=1).max()
        < 0.01 * np.linalg.norm(expected, axis=1).min()
    )


def test_friction_and_play_make_it_depend_on_where_it_came_from():
    damaged = bent()
    joints = postures(damaged, 3)

    def gap(gears):
        there, back = (
            PhysicsStation(damaged, gears).forward(way) for way in (joints, joints[::-1])
        )
        return position_error(there, back[::-1]).max()

    assert gap(Gears(1e4)) < 1e-6
    rubbing, loose = gap(Gears(1e4, friction=5.0)), gap(Gears(1e4, play=1e-3))
    assert 5e-5 < rubbing < 5e-3 and 5e-5 < loose < 5e-3


def test_encoders_say_what_was_asked_for_and_the_instrument_sees_the_target():
    damaged, target, instrument = bent(), np.eye(4), np.eye(4)
    target[:3, 3], instrument[:3, 3] = [0, 0, 0.1], [1, 0, 0]
    station: Station = PhysicsStation(damaged, instrument=instrument, target=target)
    angles = postures(damaged, 1)[0]
    station.move(angles, 0.5)
    assert np.array_equal(station.angles(), angles)
    seen, pose = station.measure(), station.pose()
    expected = (pose @ target)[:3, 3] - [1, 0, 0]
    assert np.allclose([seen["x [m]"], seen["y [m]"], seen["z [m]"]], expected)
    assert list(seen)[3:] == ["qx", "qy", "qz", "qw"]


def test_motors_go_straight_and_slowly_from_start_to_goal(monkeypatch):
    """At most as fast as the fastest joint may be, which takes it the whole way."""
    damaged, asked = intact("panda"), []
    station = PhysicsStation(damaged)
    start, goal = postures(damaged, 2)
    station.move(start)
    monkeypatch.setattr(station, "_hold", lambda angles, missed=0.0: asked.append(angles.copy()))
    station.move(goal, 0.5)
    shares = (np.array(asked) - start) / (goal - start)
    assert np.ptp(shares, axis=1).max() < 1e-9  # all joints together
    assert shares[0, 0] == 0 and shares[-1, 0] == 1 and (np.diff(shares[:, 0]) >= 0).all()
    speeds = np.abs(np.diff(asked[:-1], axis=0)).max(axis=0) / physics.STEP
    assert (speeds / damaged.arm.model.velocityLimit).max() == pytest.approx(0.5, rel=0.01)


def test_what_was_stopped_moves_no_more():
    damaged = bent()
    station = PhysicsStation(damaged)
    station.stop()
    station.stop()
    before = station.pose()
    with pytest.raises(StationFailed, match="stopped"):
        station.move(postures(damaged, 1)[0], 1.0)
    assert np.allclose(station.pose(), before, atol=1e-6)


def test_it_refuses_what_it_cannot_do():
    station = PhysicsStation(bent())
    with pytest.raises(StationFailed, match="limits"):
        station.move(np.full(6, 7.0), 1.0)
    table = arm_of_table([Row("a", 0.1, 0.0, 0.0, 0.0)])
    with pytest.raises(UnsuitableRobot, match="masses"):
        PhysicsStation(DamagedArm(table, np.zeros(1)))


@pytest.fixture(scope="module")
def drawing():
    """Skip where MuJoCo cannot draw at all."""
    mujoco = physics.mujoco
    try:
        mujoco.Renderer(mujoco.MjModel.from_xml_string("<mujoco/>"), 8, 8).close()
    except Exception as error:  # of EGL, which has many
        pytest.skip(f"no pictures here: {error}")


@pytest.mark.usefixtures("drawing")
def test_a_picture_shows_the_board_where_it_is(tmp_path):
    pytest.importorskip("cv2", reason="needs OpenCV, of the extra vision")
    from simulated_camera import MARGIN, UPWARDS, PicturedStation

    from recalib.vision.boards import printable
    from recalib.vision.detection import find_corners
    from recalib.vision.views import board_pose, reprojection

    damaged, board = bent(), printable(7, 5, 0.036)
    angles = np.array([0.0, -1.4, 2.1, -2.9, -1.57, 0.0])
    tool = damaged.forward(angles[None])[0]
    place = UPWARDS.copy()  # it looks the way of the tool, to the camera a metre away
    place[:3, 3] = *(board.size / [-2, 2]), 0.02
    camera = tool @ UPWARDS
    camera[:3, 3] = tool[:3, 3] + tool[:3, 2]
    station = PicturedStation(damaged, camera, place, board, tmp_path)
    assert station.measure() is None and not [*tmp_path.iterdir()]  # it looks elsewhere
    station.move(angles, 1.0)
    assert station.measure() == {"picture": str(tmp_path / "000.png")}
    assert (tmp_path / "000.png").exists()
    view = find_corners(board, station.picture())
    assert len(view.numbers) == 24
    seen, expected = (
        board_pose(board, station.lens, view),
        np.linalg.inv(camera) @ station.pose() @ place,
    )
    assert (
        np.linalg.norm((seen - expected)[:3, 3]) < 2e-3 and orientation_error(seen, expected) < 5e-3
    )
    gaps = reprojection(board, station.lens, view, expected)
    assert np.abs(gaps.mean(axis=0)).max() < 0.2  # px
    # half of the white paper about the board, which markers at its edge need
    beside = np.append(board.size * [1, 0.5] + [MARGIN / 2, 0], [0, 1])
    x, y, depth = (np.linalg.inv(camera) @ station.pose() @ place @ beside)[:3]
    focal, middle = station.lens.matrix[0, 0], station.lens.matrix[:2, 2]
    column, row = np.round(focal * np.array([x, y]) / depth + middle).astype(int)
    assert station.picture()[row, column] > 150
    station.close()


def test_identification_explains_droop():
    pytest.importorskip("cv2", reason="needs OpenCV, of the extra vision")
    from tests.bars.paper_live import calibrated

    row = calibrated(("physics", 0))
    assert row["before"] > 10 and row["geometry"] > 3 and row["after"] < 0.3  # mm
