"""A station: an arm of Universal Robots by ur_rtde, and a camera that Linux shows as /dev/video0.

pip install ur_rtde opencv-contrib-python-headless
ROBOT=192.168.0.10 recalib live examples/stations/universal_robots.py:UniversalRobot \
    ur5e_robot.urdf --tool tool0 --board board/board.toml --lens lens.yaml

After an emergency stop or a protective stop, `move` raises StationFailed, which ends the session.
Release the stop on the pendant, and call the same command again: it goes on with the table.
"""

import os
import threading
import time

import cv2
import numpy as np
from rtde_control import RTDEControlInterface
from rtde_receive import RTDEReceiveInterface

from recalib import StationFailed

FASTEST, ACCELERATION = np.pi, 0.8  # rad/s of the fastest joint at a speed of 1; rad/s^2
STANDS = 1e-3  # rad, rad/s
OLD = 5  # frames that a driver may have kept from before the arm stood
PATIENCE = 60.0  # s for a move
ARM = "shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint"
WRIST = "wrist_1_joint", "wrist_2_joint", "wrist_3_joint"


class UniversalRobot:
    joints = ARM + WRIST
    limits = np.full(6, -2 * np.pi), np.full(6, 2 * np.pi)

    def __init__(self) -> None:
        host = os.environ["ROBOT"]
        self._control, self._state = RTDEControlInterface(host), RTDEReceiveInterface(host)
        self._camera = cv2.VideoCapture(int(os.environ.get("CAMERA", "0")))
        self._stopped = threading.Event()

    def move(self, angles: np.ndarray, speed: float) -> None:
        # without waiting: moveJ would keep `stop` from being sent
        if not self._control.moveJ(angles.tolist(), speed * FASTEST, ACCELERATION, True):
            raise StationFailed("the controller refused the move")
        end = time.monotonic() + PATIENCE
        while not self._is_at(angles):
            if self._state.isEmergencyStopped() or self._state.isProtectiveStopped():
                raise StationFailed("the arm was stopped; release it on the pendant")
            if self._stopped.is_set() or time.monotonic() > end:
                self.stop()
                raise StationFailed("the arm did not arrive")
            time.sleep(0.02)
        time.sleep(0.3)  # it swings

    def _is_at(self, angles: np.ndarray) -> bool:
        still = np.abs(self._state.getActualQd()).max() < STANDS
        return bool(still and np.abs(self.angles() - angles).max() < STANDS)

    def angles(self) -> np.ndarray:
        return np.array(self._state.getActualQ())

    def measure(self) -> dict[str, float | str] | None:
        for _ in range(OLD):
            self._camera.grab()
        success, picture = self._camera.read()
        if not success:
            return None
        path = f"picture_{time.time_ns()}.png"
        cv2.imwrite(path, picture)
        return {"picture": path}

    def stop(self) -> None:
        self._stopped.set()
        self._control.stopJ(4 * ACCELERATION)

    def close(self) -> None:
        self._camera.release()
        self._control.disconnect()
