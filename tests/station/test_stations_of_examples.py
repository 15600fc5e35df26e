"""Stations for real arms, by fakes of their libraries that behave as these are documented."""

import sys
import threading
import time
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest

pytest.importorskip("cv2", reason="needs OpenCV, of the extra `vision`")

import cv2
import rerun as rr
from watched_pictures import ShownPictures

from recalib import StationFailed, load_arm
from recalib.station import open_station
from recalib.vision import projected
from tests.conftest import ROOT
from tests.logged import logged
from tests.vision.hand_eye_cells import HandEyeCell

STATIONS = ROOT / "examples" / "stations"
GOAL = np.array([0.2, -1.0, 1.1, -0.4, 0.3, 0.1])
JOINTS = ["shoulder", "upper", "elbow", "one", "two", "three"]


class Arm:
    """What stands behind both libraries: it moves at a constant speed in its own time."""

    def __init__(self):
        self.start = self.goal = np.zeros(6)
        self.began, self.seconds = time.monotonic(), 1e-9
        self.emergency = False

    def go(self, goal, seconds: float) -> None:
        self.start, self.goal = self.now(), np.array(goal)
        self.began, self.seconds = time.monotonic(), max(seconds, 1e-9)

    def halt(self) -> None:
        self.go(self.now(), 0)

    def part(self) -> float:
        return min(1.0, (time.monotonic() - self.began) / self.seconds)

    def now(self) -> np.ndarray:
        return self.start + self.part() * (self.goal - self.start)


@pytest.fixture
def arm(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return Arm()


def module(monkeypatch, name: str, **members) -> None:
    fake = ModuleType(name)
    vars(fake).update(members)
    monkeypatch.setitem(sys.modules, name, fake)


@pytest.fixture
def universal_robot(arm, monkeypatch):
    """moveJ returns whether the controller took it, and without waiting if it is asynchronous."""

    class Control:
        def __init__(self, host):
            assert host == "robot"

        def moveJ(self, q, speed, acceleration, asynchronous=False):
            assert asynchronous and len(q) == 6 and 0 < speed <= np.pi
            if arm.emergency:
                return False
            arm.go(q, np.abs(np.array(q) - arm.now()).max() / (50 * speed))
            return True

        def stopJ(self, a=2.0, asynchronous=False):
            arm.halt()

        def disconnect(self): ...

    receive = {
        "getActualQ": lambda self: arm.now().tolist(),
        "getActualQd": lambda self: [*(arm.goal - arm.start) / arm.seconds * (arm.part() < 1)],
        "isEmergencyStopped": lambda self: arm.emergency,
        "isProtectiveStopped": lambda self: False,
        "__init__": lambda self, host: None,
    }
    camera = SimpleNamespace(
        grab=lambda: True,
        read=lambda: (True, np.full((48, 64, 3), 7, np.uint8)),
        release=lambda: None,
    )
    module(monkeypatch, "rtde_control", RTDEControlInterface=Control)
    module(monkeypatch, "rtde_receive", RTDEReceiveInterface=type("Receive", (), receive))
    monkeypatch.setattr(cv2, "VideoCapture", lambda number: camera)
    monkeypatch.setenv("ROBOT", "robot")
    return open_station(f"{STATIONS}/universal_robots.py:UniversalRobot")


class Future:
    """Its result is None until it is there."""

    def __init__(self, result):
        self.result = result

    def add_done_callback(self, callback):
        while self.result() is None:
            time.sleep(0.001)
        callback(self)


@pytest.fixture
def ros_arm(arm, monkeypatch):
    """Goals are accepted or not; a result has an error code, and comes when the arm stands."""
    subscriptions, times = {}, SimpleNamespace(canceled=False, order=[0, 1, 2, 3, 4, 5])

    def goal():
        return SimpleNamespace(trajectory=SimpleNamespace(joint_names=[], points=[]))

    def outcome():
        code, text = 0, ""  # SUCCESSFUL, also of a goal that was rejected
        if (arm.emergency or times.canceled) and times.accepted:
            arm.halt()
            code, text = -4, "aborted"  # PATH_TOLERANCE_VIOLATED
        elif times.accepted and arm.part() < 1:
            return None
        return SimpleNamespace(result=SimpleNamespace(error_code=code, error_string=text))

    class Client:
        def __init__(self, node, kind, name):
            assert name == "/arm/follow_joint_trajectory"

        def send_goal_async(self, goal):
            assert goal.trajectory.joint_names == JOINTS
            (point,) = goal.trajectory.points
            times.canceled, soon = False, time.monotonic() + 0.1
            times.accepted = not arm.emergency
            handle = SimpleNamespace(
                accepted=times.accepted,
                get_result_async=lambda: Future(outcome),
                cancel_goal_async=lambda: setattr(times, "canceled", True),
            )

            def accepted():
                if time.monotonic() < soon:
                    return None
                if handle.accepted and arm.goal.tolist() != point.positions:
                    arm.go(point.positions, point.time_from_start / 50)
                return handle

            return Future(accepted)

    def joint_state():
        names = [JOINTS[joint] for joint in times.order]
        return SimpleNamespace(name=names, position=arm.now()[times.order].tolist())

    def image():
        sec, nanosec = divmod(time.time_ns(), 10**9)
        header = SimpleNamespace(stamp=SimpleNamespace(sec=sec, nanosec=nanosec))
        layout = {"height": 48, "width": 64, "step": 3 * 64 + 4, "encoding": "rgb8"}
        return SimpleNamespace(header=header, data=bytes([9, 5, 7] * 64 + [0] * 4) * 48, **layout)

    def spin(node):
        for _ in range(500):
            for kind, callback in subscriptions.items():
                callback(kind())
            time.sleep(0.01)

    node = SimpleNamespace(
        create_subscription=lambda kind, topic, callback, depth: subscriptions.update(
            {kind: callback}
        ),
        get_clock=lambda: SimpleNamespace(now=lambda: SimpleNamespace(nanoseconds=time.time_ns())),
    )
    module(monkeypatch, "rclpy", init=lambda: None, create_node=lambda name: node, spin=spin)
    module(monkeypatch, "rclpy.action", ActionClient=Client)
    duration = lambda seconds: SimpleNamespace(to_msg=lambda: seconds)  # noqa: E731
    module(monkeypatch, "rclpy.duration", Duration=duration)
    module(monkeypatch, "control_msgs")
    module(monkeypatch, "control_msgs.action", FollowJointTrajectory=SimpleNamespace(Goal=goal))
    module(monkeypatch, "sensor_msgs")
    module(monkeypatch, "sensor_msgs.msg", JointState=joint_state, Image=image)
    module(monkeypatch, "trajectory_msgs")
    module(monkeypatch, "trajectory_msgs.msg", JointTrajectoryPoint=SimpleNamespace)
    monkeypatch.setenv("ARM", "/arm/follow_joint_trajectory")
    monkeypatch.setenv("CAMERA", "/camera/image_raw")
    station = open_station(f"{STATIONS}/ros2.py:RosArm")
    times.order = [1, 2, 0, 4, 5, 3]  # another node reports them, too
    return station


@pytest.fixture(params=["universal_robot", "ros_arm"])
def station(request):
    return request.getfixturevalue(request.param)


@pytest.mark.parametrize("path", sorted(STATIONS.glob("*.py")), ids=lambda path: path.stem)
def test_a_station_is_read_in_a_minute(path):
    assert len(path.read_text().splitlines()) <= 80


def test_a_station_moves_as_fast_as_asked_and_takes_a_picture(station, arm, tmp_path):
    seconds = []
    for goal, speed in ((GOAL, 0.25), (0 * GOAL, 0.5)):  # and back
        station.move(goal, speed)
        assert station.angles() == pytest.approx(goal, abs=2e-3)
        seconds.append(arm.seconds)
    assert 1.5 < seconds[0] / seconds[1] < 2.01
    low, high = station.limits
    assert len(station.joints) == len(low) == len(high) == 6
    first, second = (station.measure()["picture"] for _ in range(2))
    assert first != second
    picture = cv2.imread(str(tmp_path / first))
    assert picture.shape == (48, 64, 3)
    assert picture[5, 5].tolist() in ([7, 7, 7], [7, 5, 9])


def test_a_universal_robot_names_its_joints_from_base_to_wrist(universal_robot):
    assert universal_robot.joints == load_arm("ur5_robot.urdf", "tool0").joints


def test_a_universal_robot_moves_no_more_after_a_stop(universal_robot, arm):
    """Which may come between the question and the move."""
    universal_robot.stop()
    with pytest.raises(StationFailed, match="did not arrive"):
        universal_robot.move(40 * GOAL, 0.5)
    assert np.abs(arm.now()).max() < np.abs(GOAL * 40).max() / 2


def test_an_emergency_stop_ends_the_session_and_the_next_one_goes_on(station, arm):
    threading.Timer(0.05, lambda: setattr(arm, "emergency", True)).start()
    with pytest.raises(StationFailed, match="stopped"):
        station.move(GOAL * 40, 0.5)
    with pytest.raises(StationFailed):
        station.move(GOAL, 0.5)
    arm.emergency = False
    station.move(GOAL, 1.0)
    assert station.angles() == pytest.approx(GOAL, abs=2e-3)


def test_stop_ends_a_move_from_another_thread(station, arm):
    threading.Timer(0.05, station.stop).start()
    start = time.monotonic()
    with pytest.raises(StationFailed):
        station.move(GOAL * 40, 0.5)
    assert time.monotonic() - start < 10
    assert np.abs(arm.now()).max() < np.abs(GOAL * 40).max() / 2
    station.stop()


def test_a_picture_is_shown_with_its_corners_and_what_they_are_off_by(tmp_path):
    """Each arrow begins at a corner, and is a hundred times as long as its error."""
    cell = HandEyeCell(3, True)
    (pose,) = cell.board_poses(cell.flange(1))
    grey = cell.draw(pose)
    cv2.imwrite(str(tmp_path / "seen.png"), grey)
    with rr.RecordingStream("live") as rec:
        rec.save(tmp_path / "live.rrd")
        shown = ShownPictures(rec, cell.board, cell.lens, True)
        assert shown.search(str(tmp_path / "seen.png"), grey)
    values = logged(tmp_path / "live.rrd")
    (corners,) = values["/picture/off Arrows2D:origins"]
    (arrows,) = values["/picture/off Arrows2D:vectors"]
    true, _ = projected(cell.board.points, cell.lens, pose)
    assert np.abs(corners.reshape(-1, 2) - true).max() < 0.5
    off = np.hypot(*arrows.reshape(-1, 2).T) / 100
    assert 0.005 < np.sqrt(np.mean(off**2)) < 0.2
    (label,) = values["/picture/size Points2D:labels"]
    assert label[1] == f"{np.sqrt(np.mean(off**2)):.2f} px off"
