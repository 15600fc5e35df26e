"""Identify an arm from positions measured to 0.1 mm, each at the most informative posture."""

import numpy as np
from ur10 import robot

import recalib
from recalib import EncoderShift, LinkShortening, position_error

rng = np.random.default_rng(1996)
damages = [LinkShortening("forearm_link", 0.04), EncoderShift("elbow_joint", 0.07)]
arm = recalib.apply(robot, damages)


def measure(angles):
    """The tool's positions (n, 3) [m] at joint angles (n, 6) [rad]: put your instrument here."""
    return arm.forward(angles)[:, :3, 3] + rng.normal(scale=1e-4, size=(len(angles), 3))


poses = robot.workspace.to_poses(robot.workspace.sample(rng, 300))
candidates, tests = np.split(recalib.Controller(robot).inverse(poses), [200])
errors = position_error(robot.arm.forward(tests), arm.forward(tests))
print(f"nominal: predictions are off by {1e3 * errors.mean():.2f} mm")
angles, measured = candidates[:10], measure(candidates[:10])
for _ in range(4):
    calibrated = recalib.calibrate(robot.arm, angles, measured)
    errors = position_error(calibrated.predict(tests), arm.forward(tests))
    print(f"{len(angles)} positions: predictions are off by {1e3 * errors.mean():.2f} mm")
    best = recalib.information_gains(calibrated.calibration, candidates).argmax()
    angles = np.vstack([angles, candidates[best]])
    measured = np.vstack([measured, measure(candidates[[best]])])
