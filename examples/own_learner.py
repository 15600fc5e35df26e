"""A learner of your own: it remembers the arm's mean error, and corrects commands by it."""

import numpy as np
from ur10 import robot

from recalib import BaseShift, Controller, Plant, apply, train


class MeanError:
    """Learns translations of the whole robot, and nothing else."""

    def __init__(self):
        self.error, self.moves = np.zeros(6), 0

    def command(self, desired):
        return desired - self.error

    def learn(self, desired, execute, fraction):
        commands = self.command(desired[:, None])
        error = execute(commands).achieved - commands
        self.moves += 1
        self.error = self.error + (error - self.error) / self.moves


plant = Plant(Controller(robot), apply(robot, [BaseShift((0.05, -0.05, 0.04))]))
desired, tests = (robot.workspace.sample(np.random.default_rng(i), 20) for i in (1, 2))
history = train(plant, MeanError(), desired, tests, measure_at=[0, 1, 20])
for moves, error in zip(history.moves, history.position_error, strict=True):
    print(f"after {moves} moves: {100 * error:.3f} cm")
