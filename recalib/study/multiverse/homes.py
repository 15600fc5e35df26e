"""Where the workspace of a robot may lie: random homes that its controller accepts."""

from dataclasses import replace

import numpy as np

from recalib.errors import UnfitWorkspace
from recalib.nominal.controller import Controller
from recalib.nominal.robots import Robot

CANDIDATES = 30000  # the pickiest arm, with a longer tool, accepts one in ten thousand


def random_home(
    robot: Robot, spread: float, greatest_condition: float, random: np.random.Generator
) -> tuple[Controller, int]:
    """The controller at the first of random homes that it accepts, and how many it refused.

    Args:
        spread: rad, how far from the robot's home each joint may be, inside its limits.
        greatest_condition: see `Controller`.
        random: whole degrees are drawn from it.

    Raises UnfitWorkspace.
    """
    low = np.ceil(np.degrees(np.maximum(robot.home - spread, robot.lower)))
    high = np.floor(np.degrees(np.minimum(robot.home + spread, robot.upper)))
    for refused in range(CANDIDATES):
        home = np.radians(random.integers(low, high, endpoint=True))
        workspace = replace(robot.workspace, centre=robot.arm.forward(home[None])[0])
        there = replace(robot, home=home, workspace=workspace)
        try:
            return Controller(there, greatest_condition), refused
        except UnfitWorkspace:
            pass
    raise UnfitWorkspace(f"the {robot.name}'s controller refuses all of {CANDIDATES} random homes")
