"""From measurements to commands: calibrate an arm, look at its errors, and correct a posture."""

import numpy as np

from recalib import calibrate, load_arm

arm, rng = load_arm("ur10_robot.urdf", "tool0"), np.random.default_rng(1996)
joints = rng.uniform(-0.5, 0.5, (40, 6)) + np.array([0, -1.2, 1.9, -2.3, -1.6, 0])
bent = joints + np.array([0.01, -0.02, 0.015, 0.01, -0.01, 0])  # in place of your arm's errors
measured = arm.forward(bent)[:, :3, 3] @ [[0, 1, 0], [-1, 0, 0], [0, 0, 1]]  # your camera's frame
calibrated = calibrate(arm, joints, measured + 1e-4 * rng.normal(size=measured.shape))
print(calibrated.summary())

desired = measured[0]  # where the tool is wanted, in the camera's frame
commands = calibrated.correct(desired, near=joints[0])
print("send", np.degrees(commands.joints[0]).round(2), "to reach", desired.round(4))
