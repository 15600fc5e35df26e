from itertools import product

import numpy as np
import pytest

from recalib import IMPROVED, HierarchicalLearner, Outcome, Rules, Schedule
from recalib.learners import regular_grid
from tests.reference import SlowMap, cycle

WIDTHS = {False: {"pose": (0.5, 0.8)}, True: {"position": (0.4, 0.9), "orientation": (1.1, 0.3)}}
SIZES = {"supernet": (2, 3, 1), "subnet": (1, 2, 2)}


def strange_world(commands):
    """A smooth damage of its own for each coordinate; (run, move, 6)."""
    bent = 0.1 * np.sin(commands[..., [1, 2, 3, 4, 5, 0]] + 0.3)
    mixed = commands + bent - 0.05 * commands**2 + 0.2
    return Outcome(mixed, np.ones(commands.shape[:2], dtype=bool))


def refusing_world(commands):
    """It refuses every third move or so."""
    executed = np.sin(50 * commands.sum(axis=-1)) > -0.5
    return strange_world(commands)._replace(executed=executed)


SWITCHES = [*product([False, True], repeat=4)]
CONVENTIONS = [
    {"centres": "faces"},
    {"metric": (0.25, 0.3, 0.25, 0.35, 0.35, 0.35)},
    {"metric": (25, 30, 25, 20, 20, 20)},
    {"rate": "linear"},
    {"rate": "exponential"},
    {"dimensions": 6},
    {"spread": "logarithms"},
    {"width_units": (0.9, 1.1, 0.9, 0.7, 0.8, 0.6)},
    {"initial": 3},
]
CASES = [(switches, {}) for switches in SWITCHES]
CASES += [(switches, each) for each in CONVENTIONS for switches in (SWITCHES[0], SWITCHES[-1])]
CASES += [((True, False, True, True), {"initial": 3})]  # values of theta, in two maps


def fallen(rules, f, start, rates):
    """The learning rate, and for each map the widths of g_k and g_kl, after a part of training."""
    widths = WIDTHS[rules.separate_maps].values()
    power = (1 if rules.spread == "widths" else 0) - rules.dimensions
    if rules.equal_visits:
        now = [
            tuple((start**power + (e**power - start**power) * f) ** (1 / power) for e in ends)
            for ends in widths
        ]
    else:
        now = [tuple(start * (e / start) ** f for e in ends) for ends in widths]
    if rules.rate == "linear" or (rules.rate is None and rules.equal_visits):
        return rates[0] + (rates[1] - rates[0]) * f, now
    return rates[0] * (rates[1] / rates[0]) ** f, now


def written_out(learner, desired, start, rates):
    """The maps of each run after learning by the paper, written out cell by cell."""
    rules, start_theta = learner.rules, None
    grids = [regular_grid(SIZES[net], rules.centres) for net in ("supernet", "subnet")]
    if rules.initial is not None and not rules.theta_increments:
        shape = (*map(len, grids), 6)
        start_theta = np.random.default_rng(rules.initial).uniform(-1, 1, shape)
    of_runs = []
    for poses in desired:
        maps = [SlowMap(*grids, outputs, start_theta) for outputs in rules.maps.values()]
        for t, u in enumerate(poses):
            cycle(
                maps,
                u,
                lambda c: [part[0, 0] for part in refusing_world(c[None, None])],
                *fallen(rules, t / len(poses), start, rates),
                rules.theta_increments,
                rules.jacobian_increments,
                np.array(rules.metric),
                np.array(rules.width_units),
            )
        of_runs.append(maps)
    return of_runs


@pytest.mark.parametrize(("switches", "convention"), CASES)
def test_the_rules_agree_with_the_paper_written_out_cell_by_cell(switches, convention):
    runs, iterations = 2, 40  # more than are kept back
    rules = Rules(*switches, **SIZES, **convention)
    learner = HierarchicalLearner(rules, Schedule(1.5, WIDTHS[switches[0]], 0.9, 0.3), runs=runs)
    desired = np.random.default_rng(5).uniform(-1, 1, (runs, iterations, 6))
    for t in range(iterations):
        learner.learn(desired[:, t], refusing_world, t / iterations)
    slow = written_out(learner, desired, 1.5, (0.9, 0.3))
    tests = np.random.default_rng(6).uniform(-1, 1, (runs, 20, 6))
    expected = [
        [np.concatenate([m.output(u) for m in slow[run]]) for u in tests[run]]
        for run in range(runs)
    ]
    assert np.allclose(learner.command(tests), expected, atol=1e-12)
    for run, maps in enumerate(learner.state()):
        for held, expected_map in zip(maps.values(), slow[run], strict=True):
            for k, l in product(range(6), range(4)):
                assert np.allclose(held["theta"][k, l], expected_map.theta[k, l], atol=1e-12)
                assert np.allclose(held["jacobian"][k, l], expected_map.A[k, l], atol=1e-12)


def improved(runs=1):
    widths = {"position": (0.6, 1.5), "orientation": (1.0, 1.0)}
    return HierarchicalLearner(IMPROVED, Schedule(4.0, widths, 0.8, 0.4), runs=runs)


@pytest.mark.parametrize(
    ("centres", "along"), [("boxes", [-2 / 3, 0, 2 / 3]), ("faces", [-1, 0, 1])]
)
def test_cells_are_a_regular_grid_of_the_workspace(centres, along):
    grid = regular_grid((3, 1), centres)
    assert grid == pytest.approx(np.array([along, [0, 0, 0]]).T)
