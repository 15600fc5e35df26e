"""From a table of measurements to commands, as `recalib calibrate` and `recalib correct` do it."""

import csv
import tempfile
from pathlib import Path

import numpy as np

from recalib import Measurements, calibrate_arm, correct, load_arm, verdict

arm, rng = load_arm("ur10_robot.urdf", "tool0"), np.random.default_rng(1996)
joints = rng.uniform(-0.5, 0.5, (40, 6)) + np.array([0, -1.2, 1.9, -2.3, -1.6, 0])
bent = joints + np.array([0.01, -0.02, 0.015, 0.01, -0.01, 0])  # in place of your arm's errors
measured = arm.forward(bent)[:, :3, 3] @ [[0, 1, 0], [-1, 0, 0], [0, 0, 1]]  # your camera's frame
table = Path(tempfile.mkdtemp()) / "measurements.csv"
with table.open("w", newline="") as stream:
    writer = csv.writer(stream)
    writer.writerow([*(f"{joint} [rad]" for joint in arm.joints), "x [m]", "y [m]", "z [m]"])
    writer.writerows(np.hstack([joints, measured + 1e-4 * rng.normal(size=measured.shape)]))

result = calibrate_arm("ur10_robot.urdf", table, tool="tool0")
commands = correct(result.correction, Measurements(1, joints[:1]))
print("for", np.degrees(joints[0]).round(2), "send", np.degrees(commands.joints[0]).round(2))
print(verdict(result))
