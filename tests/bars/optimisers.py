"""CMA-ES next to differential evolution: python -m tests.bars.optimisers [TRIALS].

Each searches twice with as many trials, by other seeds and on other poses. The errors that remain
with its two winners, on fresh poses, show how good an optimiser is and how much it varies.
"""

import sys
from pathlib import Path

import numpy as np
from scipy.optimize import differential_evolution

from replication.campaign.measuring import Replicate
from replication.campaign.setups import read_design
from replication.campaign.variants import variants
from replication.config.reading import read_study
from replication.config.shipped import DESIGN
from replication.training.poses import Stream
from replication.training.search import Search, worse
from replication.training.trials import Trials

ITERATIONS = {"improved": 200, "ritter_separate_maps": 500, "ritter": 500}
POPULATION = 4  # of differential evolution, for each parameter


def by_cma_es(trials: Trials, seed: int, most: int) -> np.ndarray:
    search = Search(trials, worse, seed, start=None)
    search.begin(most, times=1)
    return search.best


def by_differential_evolution(trials: Trials, seed: int, most: int) -> np.ndarray:
    space = trials.space

    def score(points: np.ndarray) -> np.ndarray:
        return np.minimum(worse(trials.shares(space.rows(points.T))), 1e9)  # not infinite

    size = len(space.coordinates)
    found = differential_evolution(
        score, [(0, 1)] * size, rng=seed, popsize=POPULATION, tol=0, polish=False,
        maxiter=most // (POPULATION * size) - 1, vectorized=True, updating="deferred",
    )  # fmt: skip
    return space.rows(found.x[None])[0]


def main(most: int = 640) -> None:
    study = read_study(Path("config.yaml"))
    replicate, plan = Replicate(study, read_design(Path(DESIGN))[0], 0), study.search
    print(f"share of the errors that remains, in two searches of {most} trials")
    for name, iterations in ITERATIONS.items():
        variant = variants(study)[name]
        runs = plan.runs if iterations <= plan.long else plan.long_runs
        fresh = replicate.trials(variant, iterations, plan.fresh, Stream.SEARCH, number=0)
        for optimise in by_cma_es, by_differential_evolution:
            rows = [
                optimise(
                    replicate.trials(variant, iterations, runs, Stream.SEARCH, number=number),
                    plan.seed + number,
                    most,
                )
                for number in (1, 2)
            ]
            left = " ".join(f"{share:8.3%}" for share in worse(fresh.shares(np.stack(rows))))
            print(f"{name:22} {iterations:5} {optimise.__name__:27} {left}", flush=True)


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
