"""How fast are moves and trainings, in one process and beside a bare Pinocchio loop of the same moves?"""

import time

import numpy as np
import pinocchio as pin

from recalib.damaged.plant import Plant
from recalib.nominal.kinematics import tool_frame
from recalib.storage import whole
from recalib.study.experiments import campaign, tuned
from recalib.training import train
from workflow.scripts.job import job

RUNS, MOVES, REPEATS, ITERATIONS = 20, 500, 5, 500


def bare_loop(robot, arm, angles):
    """What one move costs at least: one Newton step less than none. Nominal Jacobian and damaged forward kinematics."""
    nominal, damaged = robot.arm.model, arm.arm.model
    data, other = nominal.createData(), damaged.createData()
    frame = tool_frame(nominal, robot.arm.tool)
    for q in angles:
        pin.computeFrameJacobian(nominal, data, q, frame, pin.LOCAL_WORLD_ALIGNED)
        pin.forwardKinematics(damaged, other, q + arm.offsets)
        pin.updateFramePlacement(damaged, other, frame)


def seconds(function, *arguments):
    start = time.perf_counter()
    function(*arguments)
    return time.perf_counter() - start


with job(snakemake):
    config = snakemake.config
    controller, arm = campaign.load_scenario(snakemake.input.scenario, config)
    plant, rng = Plant(controller, [arm]), np.random.default_rng(0)
    commands = rng.uniform(-1, 1, (MOVES, RUNS, 1, 6))
    angles = controller.inverse(controller.robot.workspace.to_poses(commands.reshape(-1, 6)))
    # Both in turn, and the ratio pair by pair: the machine may be shared.
    pairs = [
        (
            seconds(lambda: [plant.execute(each) for each in commands]),
            seconds(bare_loop, controller.robot, arm, angles),
        )
        for _ in range(REPEATS)
    ]
    ours, bare = np.median(pairs, axis=0) / len(angles)
    lines = [
        f"moves, {RUNS} runs side by side: {1 / ours:,.0f} a second",
        f"bare loop of one Jacobian and one forward kinematics a move: {1 / bare:,.0f} a second",
        f"ratio, median of {REPEATS} pairs: {np.median([a / b for a, b in pairs]):.1f}",
    ]
    for name in ("improved", "ritter"):
        which = tuned.training(name, config["learners"])
        desired = campaign.desired_poses(0, "bench", range(RUNS), ITERATIONS)
        learner = tuned.build(which, RUNS, config["learners"], config["tuned"])
        spent = seconds(
            train, Plant(controller, [arm]), learner, desired, desired[:, :1], [ITERATIONS]
        ) / (RUNS * ITERATIONS)
        lines.append(
            f"{name}: {1e6 * spent:.0f} us an iteration and seed, {10_000 * spent:.2f} s for 10,000 iterations"
        )
    with whole(snakemake.output[0]) as path:
        path.write_text("\n".join(lines) + "\n")
    print("\n".join(lines))
