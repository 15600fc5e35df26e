"""Random homes of a robot at which its controller accepts the workspace."""

from dataclasses import replace
from itertools import product

import numpy as np

from recalib.errors import UnfitWorkspace
from recalib.nominal.chain import TOLERANCE, Chain
from recalib.nominal.controller import Controller
from recalib.nominal.robots import Robot
from replication.scenarios.plants import Nominal, nominal_robot

CORNERS = np.array(list(product((-1.0, 1.0), repeat=6)))
CANDIDATES = 30000  # the most restrictive arm, with a longer tool, accepts one home in 10,000


def random_home(
    nominal: Nominal, spread: float, random: np.random.Generator
) -> tuple[Controller, int]:
    """The controller at the first random home that it accepts, and the number of refused homes.

    Args:
        spread: rad, greatest distance of each joint from the robot's home, within its limits.
        random: the generator that draws homes, in whole degrees.

    Raises UnfitWorkspace.
    """
    robot = nominal_robot(nominal)
    low = np.ceil(np.degrees(np.maximum(robot.home - spread, robot.lower)))
    high = np.floor(np.degrees(np.minimum(robot.home + spread, robot.upper)))
    chain = Chain.of(robot.arm)
    for refused in range(CANDIDATES):
        home = np.radians(random.integers(low, high, endpoint=True))
        workspace = replace(robot.workspace, centre=robot.arm.forward(home[None])[0])
        candidate = replace(robot, home=home, workspace=workspace)
        if _reaches_corners(candidate, chain):
            try:
                return Controller(candidate, nominal.controller.greatest_condition), refused
            except UnfitWorkspace:
                pass
    raise UnfitWorkspace(f"the {robot.name}'s controller refuses all of {CANDIDATES} random homes")


def _reaches_corners(robot: Robot, chain: Chain) -> bool:
    """Whether the arm reaches the corners of its workspace: a fast test that most homes fail."""
    for corners in (CORNERS[::9], CORNERS):
        angles = np.tile(robot.home, (len(corners), 1))
        for part in (0.5, 1):  # from home outwards: all corners on the same branch of solutions
            angles, residuals = chain.solve(robot.workspace.to_poses(part * corners), angles)
            within = (robot.lower <= angles) & (angles <= robot.upper)
            if not (np.all(residuals <= TOLERANCE) and within.all()):
                return False
    return True
