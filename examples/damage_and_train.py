"""Damage an arm, train the improved map of the paper on it, and plot how the errors fall."""

import matplotlib.pyplot as plt
import numpy as np
from ur10 import robot

from recalib import IMPROVED, Controller, HierarchicalLearner, Plant, Schedule, train
from recalib.damaged.damage import EncoderShift, LinkShortening, apply

damages = [LinkShortening("forearm_link", 0.04), EncoderShift("elbow_joint", np.radians(4))]
plant = Plant(Controller(robot), [apply(robot, damages)])

widths = {"position": (0.6, 1.5), "orientation": (1.0, 1.0)}
learner = HierarchicalLearner(1, IMPROVED, Schedule(4.0, widths, 0.8, 0.4))

rng = np.random.default_rng(1996)
desired = robot.workspace.sample(rng, 1, 200)  # one run of 200 iterations
tests = robot.workspace.sample(rng, 1, 100)
history = train(plant, learner, desired, tests, measure_at=range(0, 201, 10))

centimetres, degrees = 100 * history.position[0, :, 0], np.degrees(history.orientation[0, :, 0])
for moves, position, orientation in zip(history.moves, centimetres, degrees, strict=True):
    print(f"after {moves:3} moves: {position:.3f} cm, {orientation:.3f} deg")

plt.semilogy(history.moves, centimetres, label="position error [cm]")
plt.semilogy(history.moves, degrees, label="orientation error [deg]")
plt.xlabel("moves")
plt.legend()
plt.show()
