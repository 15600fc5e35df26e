"""Calibrate a seven-joint arm without an instrument: a ball on its hand, set into two sockets."""

import math

import numpy as np
from scipy.spatial.transform import Rotation

from recalib import Chain, calibrate, load_arm

rng = np.random.default_rng(1996)
arm, home = load_arm("panda.urdf", "panda_hand_tcp"), np.array([0, 0.2, 0, -2, 0, 2.2, 0.8])
offsets = np.radians([0.5, -0.8, 0.6, 0.9, -0.7, 0.8, 0.4])  # in place of your arm's errors
sockets = np.array([[0.45, -0.2, 0.2], [0.45, 0.2, 0.35]])  # m, not measured
joints, number = home + rng.uniform(-0.7, 0.7, (80, 7)), np.repeat([0, 1], 40)
poses = arm.forward(joints)
poses[:, :3, 3] = sockets[number]  # guided by hand until the ball sits in the socket
joints = Chain.of(arm).solve(poses, joints)[0] - offsets + rng.normal(scale=2e-5, size=(80, 7))
apart = {(0, 1): math.dist(*sockets)}  # m, measured
calibration = calibrate(arm, joints, sockets=number, distances=apart).calibration
tests = home + rng.uniform(-0.5, 0.5, (100, 7))
reached = [arm.forward(tests + offsets), arm.forward(tests), calibration.forward(tests)]
# relative to their mean: sockets do not say where the arm stands
true, before, after = (each[:, :3, 3] - each[:, :3, 3].mean(axis=0) for each in reached)
for name, found in (("before", before), ("after", after)):
    left = Rotation.align_vectors(true, found)[0].apply(found) - true
    print(f"{name}: {1e3 * np.linalg.norm(left, axis=1).mean():.2f} mm")
