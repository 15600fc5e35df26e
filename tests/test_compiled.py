"""What compiles the loops of robots and learners, and that they stay within their arrays."""

import os
import sys
from dataclasses import replace

import numpy as np
from numba import config

from recalib import IMPROVED, Chain, HierarchicalLearner, Outcome, Schedule, Workspace, load_arm
from recalib.learners import WAITING
from recalib.nominal import COORDINATES, TOLERANCE
from recalib.numerics.compiled import compiled
from tests.conftest import run
from tests.nominal.test_newton import ARMS


def over(one, other):
    return one / other


def go_through_all_loops() -> None:
    """As plain Python, where a number beside an array is an error; compiled, nobody looks."""
    assert config.DISABLE_JIT
    random = np.random.default_rng(1)
    for urdf, (tool, home) in ARMS.items():
        arm, angles = load_arm(urdf, tool), home + random.uniform(-0.1, 0.1, (2, len(home)))
        chain, poses = Chain.of(arm), arm.forward(angles)
        twice = Chain.side_by_side([chain, chain]).forward(np.stack([angles, angles]))
        assert np.allclose(twice, poses)
        assert chain.solve(poses, angles + 0.01)[1].max() <= TOLERANCE
    coordinates = random.uniform(-1, 1, (3, 6))
    for kind in COORDINATES:
        workspace = Workspace(poses[0], np.full(6, 0.3), kind)
        assert np.allclose(workspace.to_coordinates(workspace.to_poses(coordinates)), coordinates)
    for separate, names in ((True, ("position", "orientation")), (False, ("pose",))):
        rules = replace(IMPROVED, separate_maps=separate, theta_increments=separate)
        schedule = Schedule(1.0, dict.fromkeys(names, (0.5, 0.5)), 0.5, 0.1)
        learner = HierarchicalLearner(rules, schedule, runs=2)
        for desired in random.uniform(-1, 1, (WAITING + 2, 2, 6)):
            learner.learn(desired, lambda sent: Outcome(1.1 * sent, np.ones((2, 1), bool)), 0.5)
        assert not np.allclose(learner.command(np.zeros((2, 1, 6)) + 0.9), 0.9)


def test_no_loop_writes_beside_an_array():
    code = "from tests.test_compiled import go_through_all_loops as go; go()"
    environment = os.environ | {"NUMBA_DISABLE_JIT": "1"}
    run(sys.executable, "-c", code, env=environment, check=True)
    assert compiled(over)(1.0, 0.0) == np.inf
