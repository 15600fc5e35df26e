"""How fast moves are, and a bare loop of Pinocchio: python -m tests.bars.moves SCENARIO.json."""

import sys
from timeit import timeit

import numpy as np
import pinocchio as pin

from recalib.damaged.damage import DamagedArm
from recalib.damaged.plant import Plant
from recalib.nominal.kinematics import tool_frame
from recalib.nominal.robots import Robot
from replication.scenarios.plants import Resolved

RUNS, MOVES, REPEATS = 20, 500, 5


def bare_loop(robot: Robot, arm: DamagedArm, angles: np.ndarray) -> None:
    """What one move costs at least: a nominal Jacobian and a damaged forward kinematics."""
    nominal, damaged = robot.arm.model, arm.arm.model
    data, damaged_data = nominal.createData(), damaged.createData()
    frame = tool_frame(nominal, robot.arm.tool)
    for q in angles:
        pin.computeFrameJacobian(nominal, data, q, frame, pin.LOCAL_WORLD_ALIGNED)
        pin.forwardKinematics(damaged, damaged_data, q + arm.offsets)
        pin.updateFramePlacement(damaged, damaged_data, frame)


def main(scenario: str) -> None:
    """Print a line for moves, one for the bare loop, and one for their ratio."""
    resolved = Resolved.read(scenario)
    controller = resolved.controller()
    robot, arm = controller.robot, resolved.arm(controller.robot)
    plant, rng = Plant(controller, arm), np.random.default_rng(0)
    commands = rng.uniform(-1, 1, (MOVES, RUNS, 1, 6))
    angles = controller.inverse(robot.workspace.to_poses(commands.reshape(-1, 6)))
    # Both in turn, and the ratio pair by pair: the machine may be shared.
    pairs = [
        (
            timeit(lambda: [plant.execute(command) for command in commands], number=1),
            timeit(lambda: bare_loop(robot, arm, angles), number=1),
        )
        for _ in range(REPEATS)
    ]
    move_time, bare = np.median(pairs, axis=0) / len(angles)
    print(f"moves, {RUNS} runs side by side: {1 / move_time:,.0f} a second")
    print(f"bare loop of one Jacobian and one forward kinematics a move: {1 / bare:,.0f} a second")
    print(f"ratio, median of {REPEATS} pairs: {np.median([a / b for a, b in pairs]):.1f}")


if __name__ == "__main__":
    main(*sys.argv[1:])
