"""Damage an arm, train the improved map of the paper on it, and plot how the errors fall."""

import matplotlib.pyplot as plt
import numpy as np
from ur10 import robot

import recalib
from recalib import EncoderShift, LinkShortening

damages = [LinkShortening("forearm_link", 0.04), EncoderShift("elbow_joint", np.radians(4))]
plant = recalib.Plant(recalib.Controller(robot), recalib.apply(robot, damages))

widths = {"position": (0.6, 1.5), "orientation": (1.0, 1.0)}
learner = recalib.HierarchicalLearner(recalib.IMPROVED, recalib.Schedule(4.0, widths, 0.8, 0.4))

rng = np.random.default_rng(1996)
desired, tests = robot.workspace.sample(rng, 200), robot.workspace.sample(rng, 100)
history = recalib.train(plant, learner, desired, tests, measure_at=range(0, 201, 10))

centimetres, degrees = 100 * history.position_error, np.degrees(history.orientation_error)
for moves, position, orientation in zip(history.moves, centimetres, degrees, strict=True):
    print(f"after {moves:3} moves: {position:.3f} cm, {orientation:.3f} deg")

plt.semilogy(history.moves, centimetres, label="position error [cm]")
plt.semilogy(history.moves, degrees, label="orientation error [deg]")
plt.xlabel("moves")
plt.legend()
plt.show()
