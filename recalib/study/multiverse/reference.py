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
from recalib.study.multiverse.measuring import SYSTEMS, measured, one_and_two_maps, ratio
from recalib.study.multiverse.universe import Universe, universe
from recalib.study.multiverse.world import World
from recalib.study.scenarios.plants import Resolved

NUMBER = -1  # it is none of the design
SCHEDULE = SWITCHES[-1]


def reference_universe(study: Study, resolved: Resolved) -> Universe:
    """The reference study as a setup: its own scenario and seed, the first level of each factor."""
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
    """The row of a replicate: as of a setup, schedules and maps of several kinds besides."""
    setup = reference_universe(study, Resolved.read(scenario))
    world = World(setup, number)
    row = {"universe": NUMBER, "replicate": number} | measured(world)
    return [row | _schedules(setup, number) | _maps(world)]


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
            with_it, without = (world.tuned(name, iterations) for name in pair)
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
