"""A learner of your own: it remembers by how much the arm lands beside, and aims beside."""

import numpy as np
from ur10 import robot

from recalib import Controller, Plant, train
from recalib.damaged.damage import BaseShift, apply


class MeanMiss:
    """Learns translations of the whole robot, and nothing else."""

    def __init__(self, runs):
        self.miss, self.moves = np.zeros((runs, 1, 6)), 0

    def command(self, desired):
        return desired - self.miss

    def learn(self, desired, execute, fraction):
        commands = self.command(desired[:, None])
        miss = execute(commands).achieved - commands
        self.moves += 1
        self.miss += (miss - self.miss) / self.moves


plant = Plant(Controller(robot), [apply(robot, [BaseShift((0.05, -0.05, 0.04))])])
desired, tests = (robot.workspace.sample(np.random.default_rng(i), 1, 20) for i in (1, 2))
history = train(plant, MeanMiss(runs=1), desired, tests, measure_at=[0, 1, 20])
for moves, error in zip(history.moves, history.position[0, :, 0], strict=True):
    print(f"after {moves} moves: {100 * error:.3f} cm")
