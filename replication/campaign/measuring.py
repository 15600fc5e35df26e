"""What is measured of a variant in a setup: rows of the campaign's table.

Nothing of a replicate is that of another one: searches, poses and runs are its own. Variants of a
replicate see the same poses.
"""

import time
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from recalib.damaged.damage import DamagedArm, EncoderShift, apply
from recalib.damaged.plant import Plant
from recalib.learners.hierarchical import HierarchicalLearner
from recalib.learners.radial import RadialLearner
from replication.campaign.setups import Setup, read_design
from replication.campaign.variants import Order, Target, Variant, lengths, variants
from replication.config.damages import damages_among
from replication.config.study import Study
from replication.config.switches import IMPROVED
from replication.scenarios.plants import nominal_controller
from replication.training.measured import ERRORS, KINDS
from replication.training.poses import ResultPoses, Stream
from replication.training.search import Score, Tuning, Winners, worse
from replication.training.settings import Space
from replication.training.trials import Trials

STEEP = 8  # power with which an error counts that is bought with the other one
SHARES = [f"{kind}_share" for kind in KINDS]
# Of the map of a target, the neighbourhood that is narrow in the paper's order, and the wide one.
NARROW_AND_WIDE: Mapping[Target, tuple[str, str]] = {
    "position": ("position_g_k", "position_g_kl"),
    "orientation": ("orientation_g_kl", "orientation_g_k"),
}

Rows = Mapping[int, Mapping[str, Any]]  # of a variant, by iterations


def measure_variant(
    study: Study, design: Path, setup: int, replicate: int, variant: str, others: list[Path]
) -> pd.DataFrame:
    """Rows of a variant in a replicate of a setup.

    Args:
        design: file of the design.
        others: files with the rows of the variants that it needs.
    """
    its = read_design(design)[setup]
    known = {path.stem: rows_of(pd.read_csv(path)) for path in others}
    measured = Replicate(study, its, replicate)
    return measured.measure(variant, variants(study)[variant], known)


def put_together(tables: list[Path]) -> pd.DataFrame:
    """The rows of all variants of a replicate."""
    return pd.concat(map(pd.read_csv, tables), ignore_index=True)


def rows_of(table: pd.DataFrame) -> Rows:
    """The rows of a variant, by iterations."""
    return {int(row["iterations"]): row for row in table.to_dict("records")}


class Replicate:
    """A setup with searches, poses and runs of its own, in which variants are measured."""

    def __init__(self, study: Study, setup: Setup, replicate: int):
        self._study, self._setup, self._replicate = study, setup, replicate
        self._controller = nominal_controller(setup.nominal(study))

    def measure(self, name: str, variant: Variant, others: Mapping[str, Rows]) -> pd.DataFrame:
        """Rows of a variant, one for each number of iterations for which it is tuned.

        Args:
            others: rows of the variants that it needs.
        """
        rows: dict[int, dict[str, Any]] = {}
        found = None
        for iterations in self._lengths(variant, others, rows):
            started = time.process_time()
            found = self._tuned(variant, iterations, others, found)
            rows[iterations] = self._row(name, variant, iterations, found)
            rows[iterations]["seconds"] = round(time.process_time() - started, 1)
        return pd.DataFrame(rows.values())

    def _lengths(self, variant: Variant, others: Mapping[str, Rows], rows: Rows) -> Iterator[int]:
        """Iterations, ascending; the last ones until the improved system's errors are reached."""
        yield from (fixed := lengths(variant, self._setup.setup))
        for iterations in variant.until_reached:
            goal = others[IMPROVED][self._study.experiments.iterations]
            if larger_share(rows[max(rows)]) <= larger_share(goal):
                return
            if iterations > fixed[-1]:
                yield iterations

    def _tuned(
        self,
        variant: Variant,
        iterations: int,
        others: Mapping[str, Rows],
        shorter: Winners | None,
    ) -> Winners:
        """Settings of a variant for so many iterations.

        Args:
            shorter: those for the next smaller number of iterations.
        """
        plan = self._study.search
        near = shorter if iterations > plan.near else None
        runs = plan.runs if iterations <= plan.long else plan.long_runs
        tuning = Tuning(
            [
                self.trials(variant, iterations, runs, Stream.SEARCH, number=number)
                for number in range(1, plan.searches + 1)
            ],
            self.trials(variant, iterations, plan.fresh, Stream.SEARCH, number=0),
            plan.model_copy(update={"seed": plan.seed + 1000 * self._replicate}),
        )
        if variant.rough:
            return tuning.rough(self._study.campaign.rough)
        score: Score = worse
        if variant.target != "both":
            held = others[variant.held][iterations] if variant.held else None
            score = of_one(variant.target, held)
        return tuning.search(score, near.rows if near else None)

    def _row(self, name: str, variant: Variant, iterations: int, found: Winners) -> dict[str, Any]:
        """What the best settings leave on poses that no search has used."""
        trials = self.trials(variant, iterations, self._study.campaign.runs, Stream.SETUP)
        ResultPoses.only(trials.poses)
        outcome = trials.outcome(found.best[None])
        row: dict[str, Any] = {
            "setup": self._setup.setup,
            "replicate": self._replicate,
            "variant": name,
            "iterations": iterations,
        }
        units = 100, np.degrees(1)
        logs, before = np.log(outcome.errors[0] * units), np.log(trials.uncorrected * units)
        for column, kind, last, first in zip(ERRORS, KINDS, logs.T, before.T, strict=True):
            row[column] = short(np.exp(last.mean()))
            row[f"{kind}_spread"] = short(last.std(ddof=1))
            row[f"{kind}_share"] = short(np.exp((last - first).mean()))
        return row | {
            "trials": found.trials,
            "apart": short(found.scores.max() / found.scores.min() - 1),
            "settled": int(found.settled),
            "refused": int(outcome.refused.sum()),
            **dict(zip(trials.space.columns, found.best.tolist(), strict=True)),
        }

    def trials(
        self, variant: Variant, iterations: int, runs: int, stream: Stream, **words: int
    ) -> Trials:
        """Trainings of a variant on poses of a stream."""
        levels, arm = self._setup.levels, self._arm(variant)
        poses = stream.draw(
            self._setup.seed,
            range(runs),
            iterations,
            self._study.training.tests,
            levels["order"],
            setup=self._setup.setup,
            replicate=self._replicate,
            **words,
        )
        return Trials(
            self._space(variant),
            poses,
            lambda _: Plant(self._controller, arm),
            levels["error"],
            RadialLearner if variant.radial else HierarchicalLearner,
        )

    def _space(self, variant: Variant) -> Space:
        rules = self._setup.rules(variant.rules, self._study, variant.improved)
        if variant.random:
            rules = replace(rules, initial=self._setup.seed + self._replicate)
        return Space(
            rules,
            self._study.search.ranges,
            narrower(variant.target, variant.order),
            dict(variant.constant),
        )

    def _arm(self, variant: Variant) -> DamagedArm:
        """The arm with the paper's damage, its encoder shifts `variant.damage` times as large."""
        damages = damages_among(self._setup.damage)
        return apply(
            self._controller.robot,
            [
                its.scaled(variant.damage) if isinstance(its, EncoderShift) else its
                for its in damages
            ],
        )


def narrower(target: Target, order: Order) -> dict[str, str]:
    """Which neighbourhood of the map of a target ends at most as wide as its other one."""
    if order == "free" or target == "both":
        return {}
    narrow, wide = NARROW_AND_WIDE[target]
    return {narrow: wide} if order == "paper" else {wide: narrow}


def of_one(target: Target, held: Mapping[str, Any] | None) -> Score:
    """The score of one error; the other one may not exceed what a row holds."""
    own = 0 if target == "position" else 1

    def score(shares: np.ndarray) -> np.ndarray:
        if held is None:
            return shares[:, own]
        beyond = np.maximum(shares[:, 1 - own] / held[SHARES[1 - own]], 1.0)
        return shares[:, own] * beyond**STEEP

    return score


def larger_share(row: Mapping[str, Any]) -> float:
    """The larger one of the shares that remain of both errors."""
    return max(row[share] for share in SHARES)


def short(value: float) -> float:
    """A number with so few digits that every machine writes the same."""
    return float(f"{value:.4g}")
