"""The arm in MuJoCo is the arm of Pinocchio, and droops as statics says."""

import numpy as np
import pytest

from recalib.damaged.damage import DamagedArm, EncoderShift, LinkShortening, apply
from recalib.nominal.arms import load_arm
from recalib.nominal.poses import orientation_error
from recalib.nominal.robots import load_robot
from recalib.station.interface import Station

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
