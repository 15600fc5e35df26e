"""The learners on an arm of seven joints with damages by name."""

import numpy as np
import pytest

from recalib import (
    Controller,
    EncoderShift,
    GaussianProcessLearner,
    GeometricLearner,
    LinkShortening,
    Plant,
    UnknownName,
    apply,
    load_robot,
    train,
)
from tests.arms import RAILED, panda
from tests.learners.test_hierarchical import improved

DAMAGES = (
    LinkShortening("panda_link4", 0.03),
    EncoderShift("panda_joint3", np.radians(4)),
    EncoderShift("panda_joint6", np.radians(-3)),
)


@pytest.fixture(scope="module")
def controller() -> Controller:
    return Controller(panda())


def left(learner, plant, iterations: int, runs: int = 2) -> np.ndarray:
    """The part of both initial errors that is left."""
    random, workspace = np.random.default_rng(5), plant.workspace
    poses = workspace.sample(random, runs, iterations), workspace.sample(random, runs, 50)
    history = train(plant, learner, *poses, [0, iterations])
    errors = np.stack([history.position[..., 0], history.orientation[..., 0]])
    return (errors[..., -1] / errors[..., 0]).mean(axis=-1)


@pytest.mark.parametrize(
    ("make", "iterations", "most"),
    [
        (lambda controller: improved(runs=2), 100, 0.15),
        (lambda controller: GaussianProcessLearner(runs=2), 60, 0.02),
        (lambda controller: GeometricLearner(controller, runs=2), 12, 1e-6),
    ],
)
def test_a_learner_recalibrates_seven_joints(make, iterations, most, controller):
    plant = Plant(controller, apply(controller.robot, DAMAGES))
    assert np.all(left(make(controller), plant, iterations) < most)


def test_an_arm_on_a_rail_slides_and_its_slide_has_no_encoder_that_turns(tmp_path):
    (path := tmp_path / "railed.urdf").write_text(RAILED)
    turns = {"pan": 0.3, "lift": -0.8, "elbow": 1.4, "bend": -0.4, "twist": 1.1, "turn": 0.5}
    sides = [0.2, 0.2, 0.2], np.radians([20, 20, 20])
    robot = load_robot(path, "link_7", {"rail": 0.2} | turns, *sides)
    controller = Controller(robot)
    slid = controller.targets(robot.workspace.sample(np.random.default_rng(4), 1, 20)).angles
    assert np.ptp(slid[..., 0]) > 0.02  # m
    plant = Plant(controller, apply(robot, [EncoderShift("elbow", 0.05)]))
    assert np.all(left(GeometricLearner(controller, runs=2), plant, 12) < 1e-6)
    with pytest.raises(UnknownName, match="unknown turning joint 'rail'; expected: bend"):
        apply(robot, [EncoderShift("rail", 0.05)])
