"""Save a trained learner, load it elsewhere, and correct commands with it."""

from dataclasses import replace
from tempfile import TemporaryDirectory

import numpy as np
from ur10 import robot

import recalib
from recalib import EncoderShift, OtherRobot, position_error

rng, workspace = np.random.default_rng(1996), robot.workspace
controller = recalib.Controller(robot)
arm = recalib.apply(robot, [EncoderShift("elbow_joint", 0.07)])
learner = recalib.GeometricLearner(controller)
desired, tests = workspace.sample(rng, 8), workspace.to_poses(workspace.sample(rng, 50))
recalib.train(recalib.Plant(controller, arm), learner, desired, desired, measure_at=[8])

with TemporaryDirectory() as folder:
    recalib.save(path := f"{folder}/learned.npz", learner, robot)
    commands = recalib.corrected(recalib.load(path, robot), workspace, tests)
    for name, sent in (("as desired", tests), ("corrected", commands)):
        errors = position_error(arm.forward(controller.inverse(sent)), tests)
        print(f"commanded {name}: mean error {1e3 * errors.mean():.6f} mm")
    try:
        recalib.load(path, replace(robot, home=robot.home + 0.1))
    except OtherRobot as error:
        print(error)
