"""The reference study measured as the alternative setups are, and in more detail.

Its replicates say what luck does to its numbers.
"""

from itertools import product
from pathlib import Path

import numpy as np

from recalib.study.configuration import lengths
from recalib.study.configuration.study import Study
from recalib.study.configuration.switches import IMPROVED, RITTER, SWITCHES
from recalib.study.inference.measured import ERRORS, MOVED
from recalib.study.multiverse.design import Designed
from recalib.study.multiverse.measuring import measured, one_and_two_maps, ratio
from recalib.study.multiverse.universe import Universe, universe
from recalib.study.multiverse.world import World
from recalib.study.scenarios.plants import Resolved

NUMBER = -1  # it is none of the design
MAPS, SCHEDULE = SWITCHES[0], SWITCHES[-1]
SYSTEMS = {"improved": (MAPS.without, IMPROVED), "ritter": (RITTER, MAPS.added)}


def reference_universe(study: Study, resolved: Resolved) -> Universe:
    """The reference study as a setup: the first level of each factor, and its own seed.

    Args:
        resolved: the study's own scenario.
    """
    factors = study.universes.factors
    home = study.robots[study.robot].home.values()
    designed = Designed(
        universe=NUMBER,
        row=NUMBER,
        seed=study.seed,
        levels={name: str(levels[0]) for name, levels in factors},
        home_deg=tuple(np.degrees(list(home)).tolist()),
        homes_refused=0,
        moved=study.scenarios[MOVED],
        damage=resolved.damages,
        position_error_cm=resolved.initial_position_error_cm,
        orientation_error_deg=resolved.initial_orientation_error_deg,
    )
    return universe(study, designed)


def reference(scenario: Path, study: Study, number: int) -> list[dict[str, float]]:
    """The row of one replicate of the reference study.

    Args:
        scenario: file of the study's own scenario as resolved.
        number: of the replicate.
    """
    return [replicated(reference_universe(study, Resolved.read(scenario)), number)]


def replicated(setup: Universe, replicate: int) -> dict[str, float]:
    """One replicate: what is measured in a setup, schedules and maps of several kinds besides."""
    world = World(setup, replicate)
    row = {"universe": NUMBER, "replicate": replicate} | measured(world)
    return row | _schedules(setup, replicate) | _maps(world)


def _schedules(setup: Universe, replicate: int) -> dict[str, float]:
    """Equal visits over Ritter's schedule, for both n and both laws of the rate, by system."""
    iterations, found = setup.learners[IMPROVED].iterations, {}
    for rate, dimensions in product(("linear", "exponential"), (3, 6)):
        conventions = setup.conventions.model_copy(update={"dimensions": dimensions})
        rates = {"rate_of_visits": rate, "ritters_rate": rate}
        world = World(setup.model_copy(update={"conventions": conventions} | rates), replicate)
        for system, pair in (
            ("improved", (IMPROVED, SCHEDULE.without)),
            ("ritter", (SCHEDULE.added, RITTER)),
        ):
            with_it, without = (
                world.train(name, iterations, world.search(name, iterations).all_rounds())[:, -1]
                for name in pair
            )
            found[f"schedule_{system}_{rate}_{dimensions}"] = ratio(with_it, without)
    return found


def _maps(world: World) -> dict[str, float]:
    """Mean final errors with one map and with two, by system and number of iterations."""
    found = {}
    for (system, pair), iterations in product(SYSTEMS.items(), lengths.MAPS):
        for maps, errors in zip(
            ("one", "two"), one_and_two_maps(world, *pair, iterations), strict=True
        ):
            for error, value in zip(ERRORS, errors.mean(axis=0), strict=True):
                found[f"{maps}_{system}_{iterations}_{error}"] = value
    return found
