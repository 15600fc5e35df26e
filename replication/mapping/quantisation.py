"""Section 3: the quantisation error of different placements of cells.

"We can directly place the centers of the cells in a regular grid covering it, in order to minimize
the quantization error. These centers do not need to move".
"""

from collections.abc import Iterable, Sequence

import numpy as np
import pandas as pd
from sklearn.cluster import KMeans

from recalib.learners.nets import CENTRES, nearest, regular_grid
from recalib.learners.schedules import EXPONENTIAL, fall
from recalib.numerics.randomness import generator

SHAPE = (3, 3, 3)  # of a supernet and of a subnet (section 7)
ITERATIONS = (200, 10_000)  # of the Kohonen rule, as in the paper's two trainings
SEEDS = 10
PLACING, EVALUATING = 10_000, 20_000  # poses for k-means, and poses for each measurement
STARTS = 5  # of k-means, with each seed

# Initial and final values of the Kohonen rule: at first half the map moves, at the end one cell.
# Widths are in cells of the map.
WIDTHS, RATES = (1.5, 0.2), (0.5, 0.02)


def quantisation_error(poses: np.ndarray, centres: np.ndarray) -> float:
    """Root mean square distance of poses (n, d) from the nearest of the centres (cells, d)."""
    offsets = poses - centres[nearest(poses, centres)]
    return float(np.sqrt(np.square(offsets).sum(axis=1).mean()))


def kohonen(starts: np.ndarray, poses: np.ndarray, shape: Sequence[int]) -> np.ndarray:
    """Centres (run, cells, d) after the first step of section 2, the classical Kohonen rule.

    In iteration t of T, the winner k is the cell nearest to the pose u. Every cell i moves by

        w_i += c(t) exp(-|m_i - m_k|^2 / (2 s(t)^2)) (u - w_i),

    where m are the places of cells in the map; c and s fall exponentially over T.

    Args:
        starts: (run, cells, d) initial centres.
        poses: (run, T, d) poses to learn from.
        shape: number of cells along each axis of the map; the last axis varies fastest.
    """
    places = np.indices(shape).reshape(len(shape), -1).T
    exponents = -0.5 * np.square(places[:, None] - places).sum(axis=-1)
    centres, iterations = starts.copy(), poses.shape[1]
    for t in range(iterations):
        width, rate = (
            fall(start, end, t / iterations, EXPONENTIAL) for start, end in (WIDTHS, RATES)
        )
        offsets = poses[:, [t]] - centres
        winner = np.square(offsets).sum(axis=-1).argmin(axis=1)
        centres += rate * np.exp(exponents[winner] / width**2)[..., None] * offsets
    return centres


def k_means(poses: np.ndarray, cells: int, random: np.random.Generator) -> np.ndarray:
    """The best centres (cells, d) for poses (n, d) that k-means finds in `STARTS` attempts."""
    state = int(random.integers(2**31))
    return KMeans(cells, n_init=STARTS, random_state=state).fit(poses).cluster_centers_


def quantisation(
    seed: int,
    shape: Sequence[int] = SHAPE,
    iterations: Sequence[int] = ITERATIONS,
    seeds: int = SEEDS,
) -> pd.DataFrame:
    """The quantisation error of each placement of cells in [-1, 1]^d, for uniform poses.

    Args:
        shape: cells along each axis of the grid, and of the Kohonen map.
        iterations: numbers of iterations of the Kohonen rule, one for each placement.
        seeds: number of repetitions, each with its own poses.

    Returns a row for each placement and seed, with columns placement, seed and distance, in
    workspace coordinates. Placements are the grids "boxes" and "faces" (`CENTRES`), "kohonen_T",
    from uniform random starts, and "kmeans", a bound for the optimum. All placements of a seed are
    measured on the same poses, which differ from the poses that placed them.
    """
    cells, dimensions = int(np.prod(shape)), len(shape)
    randoms = {
        name: [generator(seed, "quantisation", name, number) for number in range(seeds)]
        for name in ("evaluating", "kmeans", *(f"kohonen_{count}" for count in iterations))
    }

    def drawn(name: str, count: int) -> np.ndarray:
        return np.stack([rng.uniform(-1, 1, (count, dimensions)) for rng in randoms[name]])

    placed: dict[str, Iterable[np.ndarray]] = {
        name: [regular_grid(shape, name)] * seeds for name in CENTRES
    }
    for count in iterations:
        name = f"kohonen_{count}"
        placed[name] = kohonen(drawn(name, cells), drawn(name, count), shape)
    placed["kmeans"] = [
        k_means(poses, cells, random)
        for poses, random in zip(drawn("kmeans", PLACING), randoms["kmeans"], strict=True)
    ]
    evaluating = drawn("evaluating", EVALUATING)
    rows = [
        {
            "placement": name,
            "seed": number,
            "distance": quantisation_error(evaluating[number], centres),
        }
        for name, repetitions in placed.items()
        for number, centres in enumerate(repetitions)
    ]
    return pd.DataFrame(rows)
