"""A station: an arm by ROS 2's action FollowJointTrajectory, and an image topic (bgr8 or rgb8).

ARM=/arm_controller/follow_joint_trajectory CAMERA=/camera/color/image_raw recalib live \
    examples/stations/ros2.py:RosArm arm.urdf --tool tool0 --board board.toml --lens lens.yaml

`lens.yaml` is what `ros2 topic echo --once` prints of camera_info. After an emergency stop, `move`
raises StationFailed, which ends the session. Recover the driver; the same command goes on.
"""

import os
import threading
import time
from functools import partial
from typing import Any

import cv2
import numpy as np
import rclpy
from control_msgs.action import FollowJointTrajectory
from rclpy.action import ActionClient
from rclpy.duration import Duration
from sensor_msgs.msg import Image, JointState
from trajectory_msgs.msg import JointTrajectoryPoint

from recalib import StationFailed

FASTEST, PATIENCE = 1.0, 10.0  # rad/s of the fastest joint at a speed of 1; s for an answer


class RosArm:
    def __init__(self) -> None:
        rclpy.init()
        self._node, self._latest = rclpy.create_node("recalib"), dict[type, Any]()
        self._action = ActionClient(self._node, FollowJointTrajectory, os.environ["ARM"])
        for kind, topic in ((JointState, "/joint_states"), (Image, os.environ["CAMERA"])):
            self._node.create_subscription(kind, topic, partial(self._latest.__setitem__, kind), 1)
        threading.Thread(target=rclpy.spin, args=(self._node,), daemon=True).start()
        self._wait(lambda: {JointState, Image} <= {*self._latest} or None)
        self.joints = [*self._latest[JointState].name]
        self.limits = tuple(np.full(len(self.joints), end) for end in (-np.pi, np.pi))

    def _wait(self, what: Any, patience: float = PATIENCE) -> Any:
        end = time.monotonic() + patience
        while (found := what()) is None and time.monotonic() < end:
            time.sleep(0.01)
        if found is None:
            raise StationFailed("ROS does not answer: is the driver running?")
        return found

    def move(self, angles: np.ndarray, speed: float) -> None:
        seconds = np.abs(angles - self.angles()).max() / (speed * FASTEST) + 0.5
        goal, to = FollowJointTrajectory.Goal(), JointTrajectoryPoint(positions=angles.tolist())
        to.time_from_start = Duration(seconds=seconds).to_msg()
        goal.trajectory.joint_names, goal.trajectory.points = self.joints, [to]
        self._latest[ActionClient] = accepting = self._action.send_goal_async(goal)
        sent = self._wait(accepting.result)
        ended = self._wait(sent.get_result_async().result, seconds + PATIENCE).result
        if not sent.accepted or ended.error_code:  # zero is SUCCESSFUL
            raise StationFailed(f"the arm stopped on its way: {ended.error_string}")
        time.sleep(0.3)  # it swings

    def angles(self) -> np.ndarray:
        state = self._latest[JointState]
        return np.array([state.position[state.name.index(joint)] for joint in self.joints])

    def measure(self) -> dict[str, float | str] | None:
        now, path = self._node.get_clock().now().nanoseconds, f"picture_{time.time_ns()}.png"
        image = self._wait(lambda: self._picture(now))
        shape = image.height, image.width, 3
        picture = np.ndarray(shape, "u1", bytes(image.data), strides=(image.step, 3, 1))
        cv2.imwrite(path, picture[..., ::-1] if image.encoding == "rgb8" else picture)
        return {"picture": path}

    def _picture(self, since: int) -> Any:
        stamp = (image := self._latest[Image]).header.stamp
        return image if 10**9 * stamp.sec + stamp.nanosec > since else None

    def stop(self) -> None:
        if accepting := self._latest.get(ActionClient):
            accepting.add_done_callback(lambda sent: sent.result().cancel_goal_async())
