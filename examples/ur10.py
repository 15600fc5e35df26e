"""The robot of these examples, from plain numbers. Yours needs its own URDF, tool and home."""

import numpy as np

from recalib import load_robot

robot = load_robot(
    "ur10_robot.urdf",  # of example-robot-data; or the path of any other file
    tool="tool0",
    home={
        "shoulder_pan_joint": 0.0,  # rad
        "shoulder_lift_joint": -1.4,
        "elbow_joint": 2.1,
        "wrist_1_joint": -2.9,
        "wrist_2_joint": -1.57,
        "wrist_3_joint": 0.0,
    },
    position_range=[0.5, 0.6, 0.5],  # m, the whole box about the home pose
    orientation_range=np.radians([40, 40, 40]),
)
