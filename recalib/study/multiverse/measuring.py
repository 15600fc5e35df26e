"""What one replicate of a setup measures: a number for each claim that a choice can change.

docs/registration.md says what each number is for. Errors are geometric means over the seeds; a
comparison is a ratio of errors, or of their geometric mean over position and orientation.
"""

import numpy as np
import pandas as pd

from recalib.learners.radial import RadialLearner
from recalib.study.configuration.switches import IMPROVED, RITTER, SWITCHES
from recalib.study.experiments.search import NETS
from recalib.study.experiments.trials import best_of
from recalib.study.inference.intervals import combined
from recalib.study.inference.measured import ERRORS, KINDS, NONE, RIGID
from recalib.study.mapping.coupling import coupling
from recalib.study.multiverse.universe import Universe
from recalib.study.multiverse.world import World

WORKSPACE = 2.0  # wide: a neighbourhood that is as wide holds all of it
LATE = 1000  # iterations: after 200, Ritter's has hardly begun, and nothing can be compared
MAPS, *OTHERS = SWITCHES
# Trainings with one map and with two.
SYSTEMS = {"improved": (MAPS.without, IMPROVED), "ritter": (RITTER, MAPS.added)}
POSES = 200  # where the Jacobian of the true mapping is taken


def measure(universe: Universe) -> list[dict[str, float]]:
    """A row for each replicate of a setup."""
    return [
        {"universe": universe.number, "replicate": replicate} | measured(World(universe, replicate))
        for replicate in range(universe.replicates)
    ]


def measured(world: World) -> dict[str, float]:
    """The numbers of one replicate, by the columns of the table of outcomes."""
    iterations = world.universe.learners[IMPROVED].iterations
    pairs = [(IMPROVED, RITTER), *((switch.without, switch.added) for switch in OTHERS)]
    trials = {name: world.search(name, iterations).all_rounds() for pair in pairs for name in pair}
    ours, ritters = (world.train(name, iterations, trials[name]) for name in (IMPROVED, RITTER))
    few = trials[IMPROVED].iloc[: world.universe.rough_trials]  # as many as a rough search has
    row = {}
    for moment, when in (("initial", 0), ("final", -1)):
        for error, value in zip(ERRORS, ours[:, when].mean(axis=0), strict=True):
            row[f"{moment}_{error}"] = value
    row["remaining"] = _remaining(ours).max()
    row["remaining_ritter"] = _remaining(ritters).min()
    row["remaining_rough"] = _remaining(world.train(IMPROVED, iterations, few)).max()
    for switch in OTHERS:  # the error with it over that without
        without, added = (
            world.train(name, iterations, trials[name])[:, -1]
            for name in (switch.without, switch.added)
        )
        row[f"{switch.key}_improved"] = ratio(ours[:, -1], without)
        row[f"{switch.key}_ritter"] = ratio(added, ritters[:, -1])
    for column, system, length in (
        ("maps_improved", "improved", iterations),
        ("maps_ritter", "ritter", iterations),
        ("maps_ritter_late", "ritter", LATE),
    ):
        one, two = one_and_two_maps(world, *SYSTEMS[system], length)
        row[column] = ratio(two, one)
    row |= width_order(trials[IMPROVED])
    row |= _cells(world, iterations)
    row["narrow"] = _narrow(world, iterations, ours[:, -1])
    row["radial"] = _radial(world, iterations)
    moved = (world.train(IMPROVED, iterations, trials[IMPROVED], shift) for shift in RIGID)
    row["rigid"] = max(_remaining(errors).max() for errors in moved)
    row["intact"] = world.train(IMPROVED, iterations, trials[IMPROVED], "intact").max()
    row["coupling"] = _coupling(world)
    return row


def _geometric(errors: np.ndarray) -> np.ndarray:
    """Means (2,) of errors (seed, 2) over the seeds."""
    return np.exp(np.log(errors).mean(axis=0))


def _remaining(errors: np.ndarray) -> np.ndarray:
    """The share that remains of both errors (seed, 2, 2), geometric means over the seeds.

    Of an error that is zero to begin with nothing is asked here.
    """
    there = errors[:, 0].min(axis=0) > NONE
    return _geometric(errors[:, -1, there] / errors[:, 0, there])


def ratio(ours: np.ndarray, theirs: np.ndarray) -> float:
    """Our error over theirs (seed, 2): the geometric mean over kinds and seeds."""
    return float(
        np.exp(np.subtract(*(np.log(combined(errors)).mean() for errors in (ours, theirs))))
    )


def one_and_two_maps(
    world: World, single: str, separate: str, iterations: int
) -> tuple[np.ndarray, np.ndarray]:
    """Final errors (seed, 2) with one map, and with two.

    One map is two with equal widths. So both searches go on from the winner for one map, with as
    many further trials: the search for more widths has no disadvantage.
    """
    alone = world.search(single, iterations)
    winner = best_of(alone.all_rounds())
    as_two = {f"{kind}/{net}": winner[f"pose/{net}"] for kind in KINDS for net in NETS}
    start = winner.to_dict() | as_two
    one = alone.further(winner)
    two = world.search(separate, iterations, like=single).further(start)
    return (
        world.train(single, iterations, one)[:, -1],
        world.train(separate, iterations, two)[:, -1],
    )


def width_order(trials: pd.DataFrame) -> dict[str, float]:
    """Do position commands want a narrow g_k and a wide g_kl, orientation commands the reverse?

    Rank correlations over the first round, whose trials choose all widths by themselves: positive
    where the paper is right.
    """
    from scipy.stats import spearmanr  # half a second, which only this needs

    first, found = trials[trials["round"] == 1], {}
    for kind, error, sign in zip(KINDS, ERRORS, (1, -1), strict=True):
        ratio = np.log(first[f"{kind}/g_k"] / first[f"{kind}/g_kl"])
        found[f"order_{kind}"] = sign * float(spearmanr(first[error], ratio).statistic)
    return found


def _cells(world: World, iterations: int) -> dict[str, float]:
    """Fewer cells where the paper says that they are not needed, over fewer in the other net."""
    supernet, subnet = (
        _geometric(world.tuned(name, iterations))
        for name in ("improved_small_supernet", "improved_small_subnet")
    )
    position, orientation = np.log(supernet / subnet)
    return {"cells_position": np.exp(position), "cells_orientation": np.exp(-orientation)}


def _narrow(world: World, iterations: int, ours: np.ndarray) -> float:
    """The position error as tuned over that with g_k of its map as wide as the workspace."""
    wide = world.search(IMPROVED, iterations, fixed={"position/g_k": WORKSPACE}).all_rounds()
    kept_wide = world.train(IMPROVED, iterations, wide)[:, -1]
    return float(_geometric(ours)[0] / _geometric(kept_wide)[0])


def _radial(world: World, iterations: int) -> float:
    """Radial units: the error with increments over that with values."""
    errors = []
    for name in (IMPROVED, "improved_theta_values"):
        trials = world.search(name, iterations, f"radial {name}", kind=RadialLearner).all_rounds()
        errors.append(world.train(name, iterations, trials, kind=RadialLearner)[:, -1])
    return ratio(*errors)


def _coupling(world: World) -> float:
    """Off-diagonal blocks of the true mapping over diagonal ones: 95 % of poses, worst scenario."""
    universe = world.universe
    random = np.random.default_rng([universe.seed, world.replicate])
    desired = world.controller.robot.workspace.sample(random, POSES)
    tables = (coupling(world.controller, world.arm(name), desired) for name in universe.scenarios)
    return max(table.quantile(0.95).max() for table in tables)
