"""How long a move takes, with and without learning: python -m tests.bars.moves SCENARIO.json.

Next to the improved system's training stand its kernels of moves alone, in one call, and a bare
loop of Pinocchio. All in processor time and in turn, since the machine may be shared.
"""

import sys
from collections.abc import Callable
from time import process_time

import numpy as np
import pinocchio as pin

from recalib.damaged.damage import DamagedArm
from recalib.damaged.plant import Plant
from recalib.learners.hierarchical import HierarchicalLearner
from recalib.learners.rules import IMPROVED
from recalib.learners.schedules import Schedule
from recalib.loop.training import train
from recalib.nominal.kinematics import tool_frame
from recalib.nominal.robots import Robot
from replication.scenarios.plants import Resolved

RUNS, MOVES, REPEATS = (1, 6, 60), 12_000, 5
SCHEDULE = Schedule(4.0, {"position": (0.6, 1.5), "orientation": (1.0, 1.0)}, 0.8, 0.4)


def bare_loop(robot: Robot, arm: DamagedArm, angles: np.ndarray) -> None:
    """What one move costs at least: a nominal Jacobian and a damaged forward kinematics."""
    nominal, damaged = robot.arm.model, arm.arm.model
    data, damaged_data = nominal.createData(), damaged.createData()
    frame = tool_frame(nominal, robot.arm.tool)
    for q in angles:
        pin.computeFrameJacobian(nominal, data, q, frame, pin.LOCAL_WORLD_ALIGNED)
        pin.forwardKinematics(damaged, damaged_data, q + arm.offsets)
        pin.updateFramePlacement(damaged, damaged_data, frame)


def seconds(work: Callable[[], object]) -> float:
    """The processor time that work takes."""
    started = process_time()
    work()
    return process_time() - started


def main(scenario: str) -> None:
    """Print how many microseconds a move takes for each number of runs."""
    resolved, rng = Resolved.read(scenario), np.random.default_rng(0)
    controller = resolved.controller()
    robot, arm = controller.robot, resolved.arm(controller.robot)
    for runs in RUNS:
        poses = rng.uniform(-1, 1, (runs, MOVES // runs, 6))
        desired, tests = poses[:, ::2], poses[:, :1]  # an iteration is two moves
        angles = controller.inverse(robot.workspace.to_poses(poses.reshape(-1, 6)))
        ways: dict[str, Callable[[], object]] = {
            "learning": lambda desired=desired, tests=tests, runs=runs: train(
                Plant(controller, arm),
                HierarchicalLearner(IMPROVED, SCHEDULE, runs=runs),
                *(desired, tests, [desired.shape[1]]),
            ),
            "kernels alone": lambda poses=poses: Plant(controller, arm).execute(poses),
            "Pinocchio": lambda angles=angles: bare_loop(robot, arm, angles),
        }
        times = [[seconds(work) for work in ways.values()] for _ in range(REPEATS)]
        each = 1e6 * np.median(times, axis=0) / MOVES
        words = ", ".join(f"{way} {time:5.2f}" for way, time in zip(ways, each, strict=True))
        print(f"{runs:2} runs, us a move: {words}")


if __name__ == "__main__":
    main(*sys.argv[1:])
