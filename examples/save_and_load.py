"""Save what was learned, load it elsewhere, and correct commands with it."""

from dataclasses import replace
from tempfile import TemporaryDirectory

import numpy as np
from ur10 import robot

from recalib import Controller, GeometricLearner, Plant, load, save, train
from recalib.damaged.damage import EncoderShift, apply
from recalib.errors import OtherRobot
from recalib.nominal.poses import position_error

rng, workspace = np.random.default_rng(1996), robot.workspace
controller = Controller(robot)
plant = Plant(controller, [apply(robot, [EncoderShift("elbow_joint", 0.07)])])
learner = GeometricLearner(1, controller)
train(plant, learner, workspace.sample(rng, 1, 8), workspace.sample(rng, 1, 50), measure_at=[8])

with TemporaryDirectory() as folder:
    save(path := f"{folder}/learned.npz", learner, robot)
    loaded = load(path, robot)
    desired = workspace.sample(rng, 1, 1)
    for name, commands in (("as desired", desired), ("corrected", loaded.command(desired))):
        missed = position_error(plant.achieve(commands)[0], workspace.to_poses(desired)).item()
        print(f"commanded {name}: {1e3 * missed:.6f} mm beside it")
    try:
        load(path, replace(robot, home=robot.home + 0.1))
    except OtherRobot as error:
        print(error)
