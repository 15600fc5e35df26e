import numpy as np

from recalib.identification.calibration import Calibration
from recalib.identification.design import information_gains
from recalib.identification.error_model import OFFSETS, ErrorModel
from recalib.identification.estimation import identify
from recalib.identification.observations import Observations


def test_a_pose_that_was_measured_teaches_less_than_a_new_one(robot, controller, damaged):
    workspace = robot.workspace
    angles = controller.inverse(workspace.to_poses(workspace.sample(np.random.default_rng(1), 9)))
    model = ErrorModel(robot.arm, OFFSETS)
    calibration = Calibration(
        model, identify(model, Observations(angles[:3], damaged.forward(angles[:3])))
    )
    gains = information_gains(calibration, angles)
    assert gains[:3].max() < gains[3:].min()
    assert np.all(gains > 0)
