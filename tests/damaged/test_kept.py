"""All that damaged robots do, as it is kept in files."""

from dataclasses import MISSING, fields

import numpy as np
import pytest

from recalib.damaged.damage import (
    BaseShift,
    EncoderShift,
    LinkShortening,
    apply,
)
from recalib.damaged.disturbances import Disturbances, Noise, Outliers, Repeatability
from recalib.damaged.kinds import DAMAGES, DISTURBANCES
from recalib.damaged.nongeometric import Backlash, EccentricGear, Sag
from recalib.damaged.plant import Plant
from recalib.damaged.words import words
from recalib.errors import RecalibError
from tests.kept import plain

EACH = {
    "moved": BaseShift((0.03, -0.02, 0.05), (0.04, -0.07, 0.11)),
    "shorter": LinkShortening("forearm_link", 0.04),
    "shorter along its axis": LinkShortening("wrist_1_link", 0.013, "axis"),
    "shorter at the tool": LinkShortening("wrist_3_link", 0.017),
    "shifted": EncoderShift("elbow_joint", 0.07),
    "eccentric": EccentricGear("shoulder_lift_joint", 0.02, 0.4),
    "sagging": Sag("elbow_joint", 2e-4),
    "loose": Backlash("wrist_1_joint", 0.012),
}
DISTURBED = Disturbances(Noise(2e-3, 4e-3), Repeatability(3e-3), Outliers(0.3, 0.05))
SOME = [*EACH][2:5]


def sent(seed: int, runs: int, moves: int) -> np.ndarray:
    commands = np.random.default_rng(seed).uniform(-1, 1, (runs, moves, 6))
    commands[-1, -2] *= 11  # refused
    return commands


def generators(*seeds: int) -> list[np.random.Generator]:
    return [np.random.default_rng(seed) for seed in seeds]


def done(plant, runs: int) -> list:
    """All that comes of moves, and what is counted of them."""
    outcomes = [plant.refused, *(plant.execute(sent(seed, runs, 5)) for seed in (1, 2))]
    return [*outcomes, plant.achieve(sent(3, runs, 4)), plant.moves, plant.refused]


def test_what_each_damage_does_is_as_kept(robot, data_regression):
    angles = robot.home + np.random.default_rng(4).uniform(-0.5, 0.5, (6, 6))
    found = {}
    for name, damage in EACH.items():
        larger = damage.scaled(1.7)
        arms = [apply(robot, [its]) for its in (damage, larger)]
        standing = [arm.standing(angles) - angles for arm in arms]
        found[name] = [larger, standing, [arm.forward(angles) for arm in arms]]
    every = apply(robot, EACH.values())
    data_regression.check(plain([found, every.forward(angles), every.standing(angles)]))


def test_the_words_of_damages_are_as_kept(data_regression):
    found = {}
    for kind in (*DAMAGES, *DISTURBANCES):
        said = {
            name: [
                word.key,
                word.meaning,
                word.signed,
                word.grows,
                getattr(word.quantity, "name", None),
            ]
            for name, word in words(kind).items()
        }
        usual = {its.name: its.default for its in fields(kind) if its.default is not MISSING}
        found[kind.__name__] = [kind.under, said, usual]
    found["unless given"] = Disturbances()
    data_regression.check(plain(found))


@pytest.mark.parametrize("disturbances", [None, DISTURBED], ids=["steady", "disturbed"])
def test_what_a_plant_does_is_as_kept(disturbances, controller, data_regression):
    arms = [apply(controller.robot, [EACH[name]]) for name in ("sagging", "moved")]
    luck = generators(5, 6) if disturbances else ()
    plants = [
        Plant(controller, arms, disturbances, luck),
        Plant(controller, arms[1], disturbances, generators(7, 8)),
        Plant(controller, controller.robot.arm, disturbances, generators(9, 10)),
    ]
    data_regression.check(plain([done(plant, 2) for plant in plants]))


def test_what_an_instrument_adds_is_as_kept(robot, data_regression):
    poses = robot.arm.forward(robot.home + np.linspace(-0.4, 0.4, 48).reshape(8, 6))
    parts = [Noise(1e-3, 2e-3), Outliers(0.4, 0.03), Repeatability(5e-3)]
    found = {
        str(count): [
            Disturbances.of(parts[:count]).measure(generators(1, 2), np.stack([poses, poses])),
            Disturbances.of(parts[:count]).of_joints(generators(3, 4), (5, 6)),
        ]
        for count in range(4)
    }
    data_regression.check(plain(found))


REFUSED = {
    "long": lambda robot: apply(robot, [LinkShortening("forearm_link", 0.8)]),
    "axis": lambda robot: apply(robot, [LinkShortening("wrist_1_link", 0.2, "axis")]),
    "link": lambda robot: apply(robot, [LinkShortening("elbow_link", 0.01)]),
    "joint": lambda robot: apply(robot, [EncoderShift("elbow", 0.01)]),
    "negative": lambda robot: LinkShortening("forearm_link", -0.01),
    "along": lambda robot: LinkShortening("forearm_link", 0.01, "z"),
    "endless": lambda robot: EncoderShift("elbow_joint", np.inf),
    "share": lambda robot: Outliers(1.2, 0.1),
    "noise": lambda robot: Noise(-1e-3, 0.0),
}


def test_why_damages_are_refused_is_as_kept(robot, data_regression):
    said = {}
    for name, make in REFUSED.items():
        with pytest.raises(RecalibError) as refused:
            make(robot)
        said[name] = str(refused.value)
    data_regression.check(said)
