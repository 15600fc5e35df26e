from itertools import product

import numpy as np
import pytest

from recalib import BadMeasurement, Outcome, RadialLearner, Rules, Schedule
from tests.learners.test_hierarchical import SIZES, WIDTHS, fallen, strange_world

START, RATES, FIELD = 1.5, (0.9, 0.3), 0.4
SWITCHES = [*product([False, True], repeat=3)]  # two maps, increments, equal visits


def taught(separate, increments, visits, desired, world=strange_world, **sizes):
    """A learner after as many iterations as there are desired poses (run, iteration, 6)."""
    rules = Rules(separate, increments, False, visits, **(SIZES | sizes))
    schedule = Schedule(START, WIDTHS[separate], *RATES)
    learner = RadialLearner(rules, schedule, FIELD, runs=len(desired))
    for t in range(desired.shape[1]):
        learner.learn(desired[:, t], world, t / desired.shape[1])
    return learner


def poses(*shape):
    return np.random.default_rng(len(shape)).uniform(-1, 1, (*shape, 6))


def blend(u, centres, theta):
    """What the units answer, one after the other."""
    phi = [np.exp(-np.sum((u - w) ** 2) / (2 * FIELD**2)) for w in centres]
    return u + sum(p * (theta[i] - centres[i]) for i, p in enumerate(phi)) / sum(phi)


def written_out(rules, centres, desired):
    """Commands that the units of one run hold at the end, learned unit by unit."""
    theta = centres.copy()
    for t, u in enumerate(desired):
        rate, widths = fallen(rules, t / len(desired), START, RATES)
        command = blend(u, centres, theta)
        e = u - strange_world(command[None, None]).achieved[0, 0]
        winner = int(np.argmin([np.linalg.norm(u - w) for w in centres]))
        won, w = theta[winner].copy(), centres[winner]
        for outputs, (sigma_k, sigma_kl) in zip(rules.maps.values(), widths, strict=True):
            for i, other in enumerate(centres):
                d_k, d_kl = np.sum((other - w)[:3] ** 2), np.sum((other - w)[3:] ** 2)
                g = np.exp(-d_k / (2 * sigma_k**2) - d_kl / (2 * sigma_kl**2))
                step = e if rules.theta_increments else won + e - theta[i]
                theta[i, outputs] = theta[i, outputs] + rate * g * step[outputs]
    return theta


@pytest.mark.parametrize(("separate", "increments", "visits"), SWITCHES)
def test_radial_units_agree_with_their_rules_written_out_unit_by_unit(separate, increments, visits):
    desired = poses(2, 40)
    learner = taught(separate, increments, visits, desired)
    centres = learner.nets.centres.reshape(-1, 6)
    tests = poses(2, 5, 1)[:, :, 0]
    for run in range(2):
        theta = written_out(learner.rules, centres, desired[run])
        assert np.allclose(learner.theta[run].reshape(-1, 6), theta, rtol=0, atol=1e-12)
        expected = [blend(u, centres, theta) for u in tests[run]]
        assert np.allclose(learner.command(tests)[run], expected, rtol=0, atol=1e-12)


def test_radial_units_start_as_the_exact_identity_and_an_intact_robot_leaves_them_there():
    def intact(commands):
        return Outcome(commands, np.ones(commands.shape[:2], dtype=bool))

    sizes = {"supernet": (3, 3, 3), "subnet": (3, 3, 3)}
    learner = taught(False, True, True, poses(2, 4), intact, **sizes)
    assert learner.nets.centres.shape == (27, 27, 6)
    tests = 3 * poses(2, 20)  # also beyond the workspace
    assert np.array_equal(learner.command(tests), tests)


def test_a_radial_unit_learns_by_one_move_nothing_of_a_refused_one_and_refuses_no_number():
    moves = []

    def refusing(commands):
        moves.append(commands.shape)
        return strange_world(commands)._replace(executed=np.array([[False], [True]]))

    learner = taught(False, False, True, poses(2, 3), refusing)
    changes = learner.theta - learner.nets.centres
    assert not changes[0].any() and changes[1].any()
    assert moves == [(2, 1, 6)] * 3
    with pytest.raises(BadMeasurement):
        taught(False, True, True, poses(1, 1), lambda c: Outcome(np.nan * c, [[True]]))


def test_what_a_radial_run_learns_depends_on_no_other():
    desired, tests = poses(3, 10), poses(3, 4, 1)[:, :, 0]
    beside = taught(True, False, True, desired).command(tests)
    alone = taught(True, False, True, desired[1:2]).command(tests[1:2])
    assert np.array_equal(beside[1:2], alone)
