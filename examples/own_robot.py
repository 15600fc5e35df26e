"""Recalibrate a robot of your own, given a function that executes a pose command and measures."""

import numpy as np

from recalib import ExternalRobot, PolynomialLearner, Workspace, train


class MyRobot:
    """In place of your robot and your tracker: its base was pushed, and its tool is bent."""

    def __init__(self):
        self.base, self.tool = np.eye(4), np.eye(4)
        self.base[:3, 3] = 0.04, -0.02, 0.01  # m
        self.tool[:2, :2] = [[0.998, -0.06], [0.06, 0.998]]

    def move(self, pose):
        """Command a pose (4, 4) [m] and measure it; None where the robot refuses."""
        return self.base @ pose @ self.tool if pose[2, 3] > 0.0 else None


centre = np.diag([1.0, -1.0, -1.0, 1.0])  # the tool points down
centre[:3, 3] = 0.8, 0.2, 0.3  # m
workspace = Workspace(centre, half_ranges=np.array([0.25, 0.3, 0.25, 0.35, 0.35, 0.35]))

robot, rng = ExternalRobot(workspace, MyRobot().move), np.random.default_rng(1996)
desired, tests = workspace.sample(rng, 60), workspace.sample(rng, 50)
history = train(robot, PolynomialLearner(degree=2), desired, tests, measure_at=[0, 10, 30, 60])
for moves, error in zip(history.moves, history.position_error, strict=True):
    print(f"after {moves:2} moves: {1e3 * error:.2f} mm")
