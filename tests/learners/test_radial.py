from itertools import product

import numpy as np
import pytest

from recalib import RadialLearner, Rules, Schedule
from tests.learners.test_hierarchical import SIZES, WIDTHS, fallen, strange_world

START, RATES, FIELD = 1.5, (0.9, 0.3), 0.4
SWITCHES = [*product([False, True], repeat=3)]  # two maps, increments, equal visits


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
    random, iterations = np.random.default_rng(2), 40
    desired, tests = random.uniform(-1, 1, (2, iterations, 6)), random.uniform(-1, 1, (2, 5, 6))
    rules = Rules(separate, increments, False, visits, **SIZES)
    schedule = Schedule(START, WIDTHS[separate], *RATES)
    learner = RadialLearner(rules, schedule, FIELD, runs=2)
    for t in range(iterations):
        learner.learn(desired[:, t], strange_world, t / iterations)
    centres = learner.nets.centres.reshape(-1, 6)
    for run in range(2):
        theta = written_out(learner.rules, centres, desired[run])
        assert np.allclose(learner.theta[run].reshape(-1, 6), theta, rtol=0, atol=1e-12)
        expected = [blend(u, centres, theta) for u in tests[run]]
        assert np.allclose(learner.command(tests)[run], expected, rtol=0, atol=1e-12)
