"""Calibrations by robotkinecal, in its own environment.

    python by_robotkinecal.py TASKS PREDICTIONS

It assumes that every joint turns about z, and finds no meshes of packages, so it gets the nominal
arm as links of the Robotics Toolbox with z along every axis.
"""

import sys
from pathlib import Path

import numpy as np
import roboticstoolbox as rtb
from robotkinecal import SerialRobotKineCal
from spatialmath import SE3


def frame(screw: np.ndarray) -> np.ndarray:
    """A frame (4, 4) whose z is the axis of the screw: its moment (3,) and direction (3,)."""
    moment, z = screw[:3], screw[3:]
    x = np.cross(z, np.eye(3)[np.abs(z).argmin()])
    x /= np.linalg.norm(x)
    pose = np.eye(4)
    pose[:3] = np.column_stack([x, np.cross(z, x), z, np.cross(z, moment)])
    return pose


def nominal(screws: np.ndarray, home: np.ndarray) -> rtb.Robot:
    """The arm with these axes, whose tool is at `home` where all joints are at zero."""
    links, before = [], np.eye(4)
    for number, there in enumerate([*map(frame, screws), home]):
        steps = [rtb.ET.SE3(np.linalg.inv(before) @ there), rtb.ET.Rz()]
        ets = rtb.ETS(steps[: 1 if number == len(screws) else 2])  # the tool does not turn
        parent = links[-1] if links else None
        links.append(rtb.Link(ets, name=f"link_{number}", parent=parent))
        before = there
    return rtb.Robot(links)


def predict(task: dict) -> np.ndarray:
    """Positions (m, 3) [m] that the calibrated arm should have in the fresh postures."""
    np.random.seed(0)  # noqa: NPY002 it draws directions from this
    count = len(task["screws"])
    calibration = SerialRobotKineCal(nominal(task["screws"], task["home"]), f"link_{count}")
    measured = list(task["measured"])
    if measured[0].ndim == 2:
        measured = [SE3(pose, check=False) for pose in measured]
    calibration.set_observations(list(task["joints"]), measured)
    result = calibration.solve()
    if result.is_diverging:
        print("robotkinecal reports that it diverges", file=sys.stderr)
    return np.array(
        [calibration.forward_kinematics(count + 1, joints).t for joints in task["fresh"]]
    )


if __name__ == "__main__":
    for path in sorted(Path(sys.argv[1]).glob("*.npz")):
        print(path.stem, file=sys.stderr, flush=True)
        with np.load(path) as file:
            task = dict(file)
        try:
            positions = predict(task)
        except Exception as error:  # whatever a peer raises is its result
            print(repr(error), file=sys.stderr)
            positions = np.empty((0, 3))
        np.savez(Path(sys.argv[2]) / path.name, robotkinecal=positions)
