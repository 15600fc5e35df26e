from itertools import product

import numpy as np
import pytest

from recalib.damaged.plant import Plant
from recalib.errors import InvalidSetting
from recalib.interfaces import Outcome
from recalib.learners.hierarchical import HierarchicalLearner, Schedule
from recalib.learners.maps import regular_grid
from recalib.learners.rules import SEPARATE, Rules
from tests.reference import SlowMap, cycle

SINGLE_WIDTHS = {"pose": (0.5, 0.8)}
SEPARATE_WIDTHS = {"position": (0.4, 0.9), "orientation": (1.1, 0.3)}
SIZES = {"supernet": (2, 3, 2), "subnet": (3, 1, 2)}


def strange_world(commands):
    """A smooth damage of its own for each coordinate; (run, move, 6)."""
    mixed = (
        commands + 0.1 * np.sin(commands[..., [1, 2, 3, 4, 5, 0]] + 0.3) - 0.05 * commands**2 + 0.2
    )
    return Outcome(mixed, np.ones(commands.shape[:2], dtype=bool))


@pytest.mark.parametrize(
    ("separate", "theta", "jacobian", "equal"), [*product([False, True], repeat=4)]
)
def test_the_rules_agree_with_the_paper_written_out_cell_by_cell(separate, theta, jacobian, equal):
    runs, iterations = 2, 40  # more than are kept back
    rules = Rules(separate, theta, jacobian, equal, **SIZES)
    widths = SEPARATE_WIDTHS if separate else SINGLE_WIDTHS
    learner = HierarchicalLearner(runs, rules, Schedule(1.5, widths, 0.9, 0.3))
    slices = SEPARATE.values() if separate else [slice(0, 6)]
    slow = [
        [
            SlowMap(regular_grid(SIZES["supernet"]), regular_grid(SIZES["subnet"]), rows)
            for rows in slices
        ]
        for _ in range(runs)
    ]
    desired = np.random.default_rng(5).uniform(-1, 1, (runs, iterations, 6))
    for t in range(iterations):
        fraction = t / iterations
        learner.learn(desired[:, t], strange_world, fraction)
        if equal:
            rate = 0.9 + (0.3 - 0.9) * fraction
            now = [
                tuple((1.5**-2 + (end**-2 - 1.5**-2) * fraction) ** -0.5 for end in pair)
                for pair in widths.values()
            ]
        else:
            rate = 0.9 * (0.3 / 0.9) ** fraction
            now = [tuple(1.5 * (end / 1.5) ** fraction for end in pair) for pair in widths.values()]
        for run in range(runs):
            cycle(
                slow[run],
                desired[run, t],
                lambda c: strange_world(c[None, None]).achieved[0, 0],
                rate,
                now,
                theta,
                jacobian,
            )
    tests = np.random.default_rng(6).uniform(-1, 1, (runs, 20, 6))
    expected = [
        [np.concatenate([m.output(u) for m in slow[run]]) for u in tests[run]]
        for run in range(runs)
    ]
    assert np.allclose(learner.command(tests), expected, atol=1e-12)
    for name, each in enumerate(learner.maps.values()):
        for run, k, l in product(range(runs), range(12), range(6)):
            held = each.theta.all[run, k, l], each.jacobian.all[run, k, l]
            assert np.allclose(held[0], slow[run][name].theta[k, l], atol=1e-12)
            assert np.allclose(held[1], slow[run][name].A[k, l], atol=1e-12)


@pytest.mark.parametrize(
    ("widths", "rate"),
    [
        ((0, 1), 0.5),
        ((1, -0.1), 0.5),
        ((1, 1), 0),
        ((1, 1), 1.01),
        ((1, np.array([1, np.nan])), 0.5),
    ],
)
def test_impossible_widths_and_rates_are_refused(widths, rate):
    with pytest.raises(InvalidSetting, match=r"width of a neighbourhood|learning rate"):
        Schedule(1.0, {"pose": widths}, rate, 0.1)


def improved(runs=1):
    return HierarchicalLearner(
        runs,
        Rules(True, True, True, True),
        Schedule(4.0, {"position": (0.6, 1.5), "orientation": (1.0, 1.0)}, 0.8, 0.4),
    )


def test_nothing_is_learned_from_a_refused_move():
    desired = np.random.default_rng(7).uniform(-1, 1, (2, 6))
    fresh, refused_first, refused_second = improved(2), improved(2), improved(2)

    def refuse(*moves):
        count = iter(range(2))
        return lambda commands: strange_world(commands)._replace(
            executed=np.full(commands.shape[:2], next(count) not in moves)
        )

    refused_first.learn(desired, refuse(0), 0.0)
    refused_second.learn(desired, refuse(1), 0.0)
    for name, before in fresh.maps.items():
        first, second = refused_first.maps[name], refused_second.maps[name]
        assert np.array_equal(first.theta.all, before.theta.all)
        assert np.array_equal(first.jacobian.all, before.jacobian.all)
        # the first move teaches theta, the second the Jacobians
        assert not np.array_equal(second.theta.all, before.theta.all)
        assert np.array_equal(second.jacobian.all, before.jacobian.all)


@pytest.mark.parametrize("increments", [True, False])
def test_a_run_learns_the_same_alone_and_beside_others(increments):
    """Bit for bit, also where another run's moves are refused."""
    rules = Rules(increments, increments, increments, increments)
    widths = SEPARATE_WIDTHS if increments else SINGLE_WIDTHS
    beside, alone = (HierarchicalLearner(n, rules, Schedule(1.5, widths, 0.9, 0.3)) for n in (3, 1))
    desired = np.random.default_rng(8).uniform(-1, 1, (3, 40, 6))

    def refuse_the_first(commands):
        return strange_world(commands)._replace(executed=np.array([[False], [True], [True]]))

    for t in range(40):
        beside.learn(desired[:, t], refuse_the_first if t % 3 else strange_world, t / 40)
        alone.learn(desired[1:2, t], strange_world, t / 40)
    for name, learned in alone.maps.items():
        assert np.array_equal(beside.maps[name].theta.all[1:2], learned.theta.all)
        assert np.array_equal(beside.maps[name].jacobian.all[1:2], learned.jacobian.all)


@pytest.mark.parametrize("separate", [True, False])
@pytest.mark.parametrize("sizes", [((3, 3, 3), (3, 3, 3)), ((2, 1, 4), (1, 1, 2))])
def test_a_new_learner_commands_what_is_desired(sizes, separate):
    widths = SEPARATE_WIDTHS if separate else SINGLE_WIDTHS
    fresh = HierarchicalLearner(
        2, Rules(separate, True, True, True, *sizes), Schedule(1.5, widths, 0.9, 0.3)
    )
    u = np.random.default_rng(0).uniform(-1.5, 1.5, (2, 30, 6))
    assert np.allclose(fresh.command(u), u, atol=1e-14)


def test_an_intact_robot_is_left_alone(controller, robot):
    from recalib.damaged.damage import apply

    learner, plant = improved(), Plant(controller, [apply(robot, [])])
    rng = np.random.default_rng(9)
    for t in range(50):
        learner.learn(rng.uniform(-1, 1, (1, 6)), plant.execute, t / 50)
    u = rng.uniform(-1, 1, (1, 100, 6))
    assert np.abs(learner.command(u) - u).max() < 1e-8
    assert plant.moves == 100
