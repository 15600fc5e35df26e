"""Recalibrate an arm of seven joints: by a map that sees poses alone, and by a model of it."""

import numpy as np

import recalib
from recalib import EncoderShift, LinkShortening

home = {f"panda_joint{i}": np.radians(a) for i, a in enumerate([0, -45, 0, -120, 0, 75, 45], 1)}
box = [0.2, 0.24, 0.2], np.radians([40, 40, 40])  # m, rad
robot = recalib.load_robot("panda.urdf", "panda_link8", home, *box)
damages = [LinkShortening("panda_link4", 0.03), EncoderShift("panda_joint3", np.radians(4))]

# For a pose there are many postures: the controller always takes the same one, close to home's.
controller = recalib.Controller(robot)
plant = recalib.Plant(controller, recalib.apply(robot, damages))
widths = {"position": (0.6, 1.5), "orientation": (1.0, 1.0)}
learners: list[recalib.Learner] = [
    recalib.HierarchicalLearner(recalib.IMPROVED, recalib.Schedule(4.0, widths, 0.8, 0.4)),
    recalib.HybridLearner(controller),
]

for learner, iterations in zip(learners, (200, 8), strict=True):
    rng = np.random.default_rng(1996)
    desired, tests = robot.workspace.sample(rng, iterations), robot.workspace.sample(rng, 100)
    history = recalib.train(plant, learner, desired, tests, measure_at=[0, iterations])
    first, last = 1e3 * history.position_error
    print(f"{type(learner).__name__}: {first:.3g} mm, after {iterations} iterations {last:.6f} mm")
