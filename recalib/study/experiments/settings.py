"""A learner of the paper with the widths and rates that the searches found for it."""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from recalib.learners.hierarchical import HierarchicalLearner
from recalib.learners.rules import Rules
from recalib.study.configuration.study import LearnerSettings
from recalib.study.experiments import search
from recalib.study.experiments.samples import winners

if TYPE_CHECKING:
    import pandas as pd


def rules_of(learner: LearnerSettings) -> Rules:
    """The rules that a learner's settings in the configuration describe."""
    return Rules(
        separate_maps=learner.maps == "separate",
        theta_increments=learner.theta == "increments",
        jacobian_increments=learner.jacobian == "increments",
        equal_visits=learner.schedule == "equal_visits",
        supernet=learner.supernet,
        subnet=learner.subnet,
    )


def best(trials: "pd.DataFrame") -> "pd.DataFrame":
    """The trials that the searches keep, one each."""
    return trials.loc[trials.groupby("search")["score"].idxmin()]


def build(learner: LearnerSettings, trials: Sequence[Mapping]) -> HierarchicalLearner:
    """An untrained learner, each run with the widths and rates of a trial."""
    rules = rules_of(learner)
    columns = {name: [trial[name] for trial in trials] for name in search.columns(rules)}
    return HierarchicalLearner(rules, search.schedule(columns, rules), runs=len(trials))


def build_tuned(
    learner: LearnerSettings, path: str | Path, searches: Iterable[int]
) -> HierarchicalLearner:
    """An untrained learner, each run with the widths and rates that a search in a file found.

    Args:
        searches: for each run the number of a search, from 1; beyond the last one the first
            follows again.
    """
    found = winners(path)
    return build(learner, [found[(number - 1) % len(found)] for number in searches])
