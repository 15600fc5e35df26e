"""A learner of the paper with the widths and rates that the search found for it."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from recalib.learners.hierarchical import HierarchicalLearner, Rules
from recalib.study.configuration.study import Learner
from recalib.study.experiments import search
from recalib.study.experiments.samples import best_trial

if TYPE_CHECKING:
    import pandas as pd


def rules_of(learner: Learner) -> Rules:
    """The rules that a learner's settings in the configuration describe."""
    return Rules(
        separate_maps=learner.maps == "separate",
        theta_increments=learner.theta == "increments",
        jacobian_increments=learner.jacobian == "increments",
        equal_visits=learner.schedule == "equal_visits",
        supernet=learner.supernet,
        subnet=learner.subnet,
    )


def best(trials: "pd.DataFrame") -> "pd.Series":
    """The trial that the search would keep."""
    return trials.loc[search.score(trials).idxmin()]


def build(learner: Learner, trial: Mapping, runs: int) -> HierarchicalLearner:
    """An untrained learner with the widths and rates of a trial."""
    rules = rules_of(learner)
    return HierarchicalLearner(runs, rules, search.schedule(trial, rules))


def build_tuned(learner: Learner, path: str | Path, runs: int) -> HierarchicalLearner:
    """An untrained learner with the widths and rates of the best trial in a file."""
    return build(learner, best_trial(path), runs)
