"""Campaigns in worlds whose truth is planted: analytic error surfaces in place of trainings.

Everything else is the campaign's own: variants, searches, what is held, the table, contrasts.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import pandas as pd

from replication.campaign import Replicate, Setup, Variant, narrower, rows_of
from replication.campaign.variants import variants
from replication.config import Study
from replication.training import Outcome, ResultPoses, SearchPoses, Space, Stream

ARM = np.array([0.08, 0.08])  # m, rad: errors without correction
RUN = 0.07  # deviation of a run, of the logarithm

# From a variant's name, its settings by column, iterations and the effect in this setup, to the
# logarithms (trial, 2) of the shares that it leaves.
Surface = Callable[[str, Mapping[str, np.ndarray], int, float], np.ndarray]


@dataclass(frozen=True)
class Planted:
    """Trials on an analytic surface, with the noise of a choice of poses."""

    space: Space
    poses: SearchPoses | ResultPoses
    surface: Callable[[Mapping[str, np.ndarray]], np.ndarray]
    noise: np.ndarray  # (run, 2) of these poses

    def first(self, runs: int) -> "Planted":
        return replace(self, noise=self.noise[:runs])

    def outcome(self, rows: np.ndarray) -> Outcome:
        logs = self.surface(dict(zip(self.space.columns, rows.T, strict=True)))
        errors = np.exp(logs[:, None] + self.noise) * ARM
        return Outcome(errors, np.zeros(errors.shape[:2], dtype=int))

    def shares(self, rows: np.ndarray) -> np.ndarray:
        return np.exp(np.log(self.outcome(rows).errors / ARM).mean(axis=1))

    @cached_property
    def uncorrected(self) -> np.ndarray:
        return np.tile(ARM, (len(self.noise), 1))


class PlantedReplicate(Replicate):
    """A replicate of a setup of a planted world."""

    def __init__(self, study: Study, setup: Setup, replicate: int, surface: Surface, effect: float):
        self._study, self._setup, self._replicate = study, setup, replicate
        self._surface, self._effect = surface, effect
        self.name = ""

    def trials(
        self, variant: Variant, iterations: int, runs: int, stream: Stream, **words: int
    ) -> Planted:
        key = [self._setup.seed, self._replicate, list(Stream).index(stream), *words.values()]
        noise = RUN * np.random.default_rng(key).normal(size=(runs, 2))
        kind = SearchPoses if stream is Stream.SEARCH else ResultPoses
        none = np.zeros((runs, 0, 6))

        def surface(settings: Mapping[str, np.ndarray]) -> np.ndarray:
            return self._surface(self.name, settings, iterations, self._effect)

        return Planted(self._space(variant), kind("planted", none, none), surface, noise)

    def _space(self, variant: Variant) -> Space:
        return Space(
            variant.rules,
            self._study.search.ranges,
            narrower(variant.target, variant.order),
            dict(variant.constant),
        )


def setups(count: int, seed: int) -> list[Setup]:
    """As many setups, without a robot and its levels."""
    seeds = enumerate(range(1000 * seed, 1000 * seed + count))
    return [Setup.model_construct(setup=number, seed=own) for number, own in seeds]


def campaign(
    study: Study, names: list[str], surface: Surface, effects: np.ndarray, seed: int
) -> pd.DataFrame:
    """The table of a planted world; the first three setups are measured twice.

    Variants are named after those that they need; effects (setup,) are on the logarithmic scale.
    """
    known, tables = variants(study), []
    for setup, effect in zip(setups(len(effects), seed), effects, strict=True):
        for number in range(2 if setup.setup < 3 else 1):
            replicate = PlantedReplicate(study, setup, number, surface, float(effect))
            others: dict = {}
            for name in names:
                replicate.name, variant = name, replace(known[name], at_home=())
                table = replicate.measure(name, variant, others)
                others[name] = rows_of(table)
                tables.append(table)
    return pd.concat(tables, ignore_index=True)


def valley(value: np.ndarray, optimum: float, steep: float = 0.3) -> np.ndarray:
    """A smooth valley on a logarithmic scale."""
    return steep * np.log(value / optimum) ** 2
