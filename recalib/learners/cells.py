"""The contents of all cells of a map as they are learned: theta or Jacobians, by (4) to (9).

An iteration updates every cell, but reads one. So updates are collected and applied together, by
one matrix product: it passes through memory once in `KEPT` iterations. What is read includes them.
"""

import numpy as np

from recalib.numerics.compiled import compiled

KEPT = 32  # updates, at most: more make reading one cell slower than they make updates faster


class Cells:
    """What the cells of a map hold, in each run. What one run learns depends on no other run.

    Args:
        runs: how many.
        start: (K, L, ...) before learning: numbers of any shape in each cell kl.
        increments: move the cells by an increment, (7) and (9), or draw them towards a value, (4)
            and (5).
    """

    def __init__(self, runs: int, start: np.ndarray, increments: bool):
        supernet, subnet, *self._shape = start.shape
        self._cells = np.tile(start.reshape(supernet, subnet, -1), (runs, 1, 1, 1))
        self._increments = increments
        self._kept = 0
        self._g_k, self._g_kl, self._targets = (
            np.empty((runs, KEPT, size)) for size in (supernet, subnet, self._cells.shape[-1])
        )

    @property
    def all(self) -> np.ndarray:
        """(run, K, L, ...) in all cells; written to, what they hold. Stale after an update.

        To ask makes all updates: what is learned differs, by rounding, from when one does not ask.
        """
        if self._kept:
            self._make()
        return self._cells.reshape(*self._cells.shape[:3], *self._shape)

    def at(self, k: np.ndarray, l: np.ndarray) -> np.ndarray:
        """(run, ...) in one cell (k, l) of each run, each (run,)."""
        kept = self._g_k, self._g_kl, self._targets, self._kept
        return _read(self._cells, k, l, self._increments, *kept).reshape(-1, *self._shape)

    def update(
        self, rate: np.ndarray, g_k: np.ndarray, g_kl: np.ndarray, target: np.ndarray
    ) -> None:
        """Move every cell by, or draw it towards, the target of its run.

        Args:
            rate: (run,) learning rate c'; a run learns nothing by 0.
            g_k, g_kl: (run, K) and (run, L) neighbourhoods of the winner.
            target: (run, ...) theta* or A*.
        """
        if self._kept == KEPT:
            self._make()
        np.multiply(rate[:, None], g_k, out=self._g_k[:, self._kept])
        self._g_kl[:, self._kept] = g_kl
        self._targets[:, self._kept] = target.reshape(len(target), -1)
        self._kept += 1

    def _make(self) -> None:
        """Make the updates that were kept back, run by run: so the cache holds what they need."""
        kept, self._kept = slice(self._kept), 0
        for run, cells in enumerate(self._cells):
            g_k, g_kl, targets = (
                array[run, kept] for array in (self._g_k, self._g_kl, self._targets)
            )
            if self._increments:
                spread = g_kl[:, :, None] * targets[:, None, :]
                change = g_k.T @ spread.reshape(len(g_k), -1)
            else:
                weights = g_k[:, :, None] * g_kl[:, None, :]
                cells *= _outlast(weights)[:, :, None]
                change = weights.reshape(len(g_k), -1).T @ targets
            cells += change.reshape(cells.shape)


@compiled
def _read(
    cells: np.ndarray,
    k: np.ndarray,
    l: np.ndarray,
    increments: bool,
    g_k: np.ndarray,
    g_kl: np.ndarray,
    targets: np.ndarray,
    kept: int,
) -> np.ndarray:
    """What is held by one cell of each run, with the updates made that were kept back."""
    held = np.empty((len(cells), cells.shape[-1]))
    for run in range(len(cells)):
        held[run] = cells[run, k[run], l[run]]
        for update in range(kept):
            weight = g_k[run, update, k[run]] * g_kl[run, update, l[run]]
            for number in range(held.shape[1]):
                target = targets[run, update, number]
                held[run, number] += weight * (target if increments else target - held[run, number])
    return held


@compiled
def _outlast(weights: np.ndarray) -> np.ndarray:
    """Turn the weights of updates (update, K, L) into those that they keep under the later ones.

    Each later update towards a value leaves 1 - weight of what was there. In place; returns what
    all together leave (K, L) of what was there before.
    """
    remaining = np.ones(weights.shape[1:])
    for update in range(len(weights) - 1, -1, -1):
        for k in range(weights.shape[1]):
            for l in range(weights.shape[2]):
                weight = weights[update, k, l]
                weights[update, k, l] = weight * remaining[k, l]
                remaining[k, l] *= 1 - weight
    return remaining
