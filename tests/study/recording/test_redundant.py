import numpy as np

from recalib.damaged.damage import EncoderShift, apply
from recalib.damaged.plant import Plant
from recalib.learners.polynomial import PolynomialLearner
from recalib.nominal.controller import Controller
from recalib.study.experiments.poses import Stream
from recalib.study.recording import story
from tests.arms import panda


def test_an_arm_of_seven_joints_is_watched_and_moved():
    robot = panda()
    damaged, controller = apply(robot, [EncoderShift("panda_joint3", 0.05)]), Controller(robot)
    poses = Stream.REPLAY.draw(1, [0], 5, 15)
    plant = Plant(controller, [damaged], None, [np.random.default_rng(2)])
    watched = story.watch(controller, plant, PolynomialLearner(1, 1), poses, [0, 5])
    reached = damaged.forward(watched.angles[-1])
    np.testing.assert_allclose(reached, watched.achieved[-1], rtol=0, atol=1e-12)
    motion = story.move(watched, robot.home, most=5)
    assert np.allclose(motion.angles[-1], watched.angles[-1, -1])
    bones = robot.arm.skeleton(motion.angles[-1:])
    assert bones.shape == (1, 9, 3)  # base, seven joints, tool
