"""All that each kind of learner commands, learns and keeps, as it is kept in files."""

import numpy as np
import pytest

from recalib.damaged.damage import EncoderShift, LinkShortening, apply
from recalib.damaged.disturbances import Disturbances, Noise
from recalib.damaged.plant import Plant
from recalib.errors import RecalibError
from recalib.learners.hierarchical import HierarchicalLearner
from recalib.learners.kinds import KINDS, class_of, kind_of
from recalib.learners.learned import differences, identity, join, load, read, save
from recalib.learners.polynomial import PolynomialLearner
from recalib.learners.radial import RadialLearner
from recalib.learners.rules import Rules
from recalib.learners.schedules import Schedule
from recalib.loop.interfaces import Outcome
from tests.kept import plain

RUNS, ITERATIONS = 2, 12
SIZES = {"supernet": (3, 2, 1), "subnet": (1, 2, 3)}
UNITS = {
    "metric": (0.25, 0.31, 0.27, 0.35, 0.4, 0.3),
    "width_units": (0.9, 1.1, 0.8, 0.7, 0.85, 0.6),
}
SINGLE = {"pose": (0.5, 0.8)}
SEPARATE = {"position": (0.4, 0.9), "orientation": (1.1, 0.3)}
RULES = {
    "improved": Rules(True, True, True, True, **SIZES),
    "ritter": Rules(False, False, False, False, **SIZES, initial=7),
    "theta alone": Rules(True, True, False, False, **SIZES, **UNITS, centres="faces"),
    "jacobians alone": Rules(False, False, True, True, **SIZES, dimensions=6, rate="exponential"),
    "evenly in logarithms": Rules(
        True, False, False, True, **SIZES, **UNITS, spread="logarithms", rate="linear"
    ),
}


def schedule(rules: Rules) -> Schedule:
    ends = SEPARATE if rules.separate_maps else SINGLE
    return Schedule(np.array([1.5, 1.7]), ends, np.array([0.9, 0.8]), np.array([0.2, 0.3]))


class World:
    """Each coordinate has a damage of its own, and commands too far out are refused."""

    def __init__(self):
        self.sent, self.executed = [], []

    def __call__(self, commands: np.ndarray) -> Outcome:
        turned = commands[..., [1, 2, 3, 4, 5, 0]]
        achieved = commands + 0.1 * np.sin(turned + 0.3) - 0.05 * commands**2
        executed = np.abs(commands).max(axis=-1) < 0.95
        self.sent.append(commands)
        self.executed.append(executed)
        return Outcome(np.where(executed[..., None], achieved + 0.07, 0.013), executed)


def desired(seed: int, *shape: int) -> np.ndarray:
    return np.random.default_rng(seed).uniform(-1, 1, (*shape, 6))


def trained(learner, execute=None, robot=None) -> dict:
    """What came of a training, what the learner says afterwards, and another one made of that."""
    world = World()
    for number, poses in enumerate(desired(5, ITERATIONS, RUNS)):
        learner.learn(poses, execute or world, number / ITERATIONS)
    found = {"commands": learner.command(desired(6, RUNS, 7))}
    if execute is None:
        sent = np.concatenate(world.sent, axis=1)
        found |= {"sent": sent, "executed": np.concatenate(world.executed, axis=1).sum(axis=1)}
    if hasattr(learner, "state"):
        again = type(learner).from_settings(learner.settings(), RUNS, robot)
        again.restore(learner.state())
        found |= {"settings": learner.settings(), "state": learner.state()}
        found["again"] = again.command(desired(7, RUNS, 3))
    return found


@pytest.mark.parametrize("name", RULES)
def test_what_maps_of_other_rules_learn_is_as_kept(name, data_regression):
    rules = RULES[name]
    learner = HierarchicalLearner(rules, schedule(rules), runs=RUNS)
    data_regression.check(plain(trained(learner)))


@pytest.mark.parametrize("name", ["improved", "ritter", "theta alone"])
def test_what_radial_units_learn_is_as_kept(name, data_regression):
    rules = RULES[name]
    learner = RadialLearner(rules, schedule(rules), 0.6, runs=RUNS)
    usual = RadialLearner(rules, schedule(rules), runs=RUNS)
    held = {map_: cells.all for map_, cells in learner.theta.items()}
    data_regression.check(plain([trained(learner), held, trained(usual)["commands"]]))


@pytest.mark.parametrize("degree", [1, 2])
def test_what_a_polynomial_learns_is_as_kept(degree, data_regression):
    data_regression.check(plain(trained(PolynomialLearner(degree, runs=RUNS))))


def test_what_a_gaussian_process_learns_is_as_kept(data_regression):
    found = trained(class_of("gaussian_process")(runs=RUNS))
    processes = [np.round(its["process"].pop("hyperparameters"), 1) for its in found["state"]]
    moves = [its["moves"] for its in found["state"]]
    commands = [np.round(found[name], 4) for name in ("commands", "again", "sent")]
    data_regression.check(plain([commands, moves[0]["executed"], processes]))


@pytest.fixture(scope="module")
def worn(robot):
    damages = LinkShortening("forearm_link", 0.03), EncoderShift("elbow_joint", 0.04)
    return apply(robot, [*damages, EncoderShift("wrist_3_joint", -0.03)])


@pytest.mark.parametrize("kind", ["geometric", "hybrid"])
def test_what_a_learner_of_geometry_learns_is_as_kept(kind, controller, worn, data_regression):
    noisy = Disturbances(Noise(1e-4, 2e-4))
    plant = Plant(controller, worn, noisy, [np.random.default_rng(seed) for seed in range(RUNS)])
    learner = class_of(kind)(controller, runs=RUNS)
    found = trained(learner, plant.execute, controller.robot)
    estimates = [its.estimate for its in learner.calibrations]
    data_regression.check(
        plain(
            {
                "commands": np.round(found["commands"], 5),
                "again": np.round(found["again"], 5),
                "settings": found["settings"],
                "moves": [state["moves"] for state in found["state"]],
                "terms": [its.model.names for its in learner.calibrations],
                "noise": [np.round(its.noise, 8) for its in estimates],
                "offsets": [np.round(its.parameters[-6:], 6) for its in estimates],
            }
        )
    )


REFUSED = {
    "centres": lambda: Rules(True, True, True, True, centres="corners"),
    "spread": lambda: Rules(True, True, True, True, spread="squares"),
    "rate": lambda: Rules(True, True, True, True, rate="constant"),
    "dimensions": lambda: Rules(True, True, True, True, dimensions=4),
    "metric": lambda: Rules(True, True, True, True, metric=(1.0,) * 5),
    "units": lambda: Rules(True, True, True, True, width_units=(1.0,) * 5 + (0.0,)),
    "no width": lambda: Schedule(0.0, SINGLE, 0.8, 0.4),
    "no final width": lambda: Schedule(1.0, {"pose": (0.5, 0.0)}, 0.8, 0.4),
    "no rate": lambda: Schedule(1.0, SINGLE, 0.0, 0.4),
    "rate above one": lambda: Schedule(1.0, SINGLE, np.array([0.5, 1.01]), 0.4),
    "no final rate": lambda: Schedule(1.0, SINGLE, 1.0, 0.0),
    "degree": lambda: PolynomialLearner(3),
}


def test_why_settings_are_refused_is_as_kept(data_regression):
    said = {}
    for name, make in REFUSED.items():
        with pytest.raises(RecalibError) as refused:
            make()
        said[name] = str(refused.value)
    data_regression.check(said)


def test_files_of_what_was_learned_are_as_kept(robot, makers, tmp_path, data_regression):
    found = {}
    for number, kind in enumerate(KINDS):
        learner = makers[kind](runs=RUNS)
        paths = [tmp_path / f"{kind}_{part}.npz" for part in ("one", "other", "both")]
        if kind in ("hierarchical", "polynomial"):
            trained(learner)
        for path in paths[:2]:
            save(path, learner, robot)
        join(paths[2], paths[:2])
        header, states = read(paths[2])
        header["robot"] = {
            name: its if isinstance(its[0], str) else np.array(its)
            for name, its in header["robot"].items()
        }
        again = [load(paths[2], robot, run).command(desired(number, 1, 3)) for run in (0, 3)]
        found[kind] = kind_of(learner), header, len(states), again
    other = identity(robot) | {"tool": "flange", "home": [0.1] * 6, "workspace": [0.2] * 96}
    found["differences"] = differences(identity(robot), other)
    data_regression.check(plain(found))
