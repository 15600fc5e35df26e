"""The settings with which a study trains its learners: shipped settings, or its own."""

from collections.abc import Iterable
from pathlib import Path

import numpy as np
import pandas as pd

from recalib.errors import RecalibError
from recalib.learners.hierarchical import HierarchicalLearner
from recalib.learners.rules import Rules
from replication.config.shipped import OUTCOMES
from replication.config.study import LearnerSettings, Study
from replication.config.switches import IMPROVED
from replication.training.plan import places
from replication.training.settings import Space


def rules_of(learner: LearnerSettings) -> Rules:
    """The rules that a learner's entry in the configuration describes."""
    return Rules(
        separate_maps=learner.maps == "separate",
        theta_increments=learner.theta == "increments",
        jacobian_increments=learner.jacobian == "increments",
        equal_visits=learner.schedule == "equal_visits",
        supernet=learner.supernet,
        subnet=learner.subnet,
    )


def trained(study: Study) -> set[tuple[str, int]]:
    """Each learner of the paper and number of iterations for which a study needs settings."""
    trainings = {
        (learner, iterations)
        for learners in places(study).values()
        for learner, lengths in learners.items()
        for iterations in lengths
    }
    more = [*study.benchmark.papers.items(), *study.real.twin.items()]
    if study.experiments.evidence:
        more.append((IMPROVED, study.experiments.iterations))  # for the ensemble
    return trainings | {*more}


def untuned(study: Study, project: Path = Path()) -> list[str]:
    """The learners whose settings a study needs but which are not shipped."""
    needed, shipped = trained(study), set()
    if study.settings == "shipped" and (project / OUTCOMES).exists():
        table = pd.read_csv(project / OUTCOMES).query("setup == 0 and replicate == 0")
        shipped = set(zip(table["variant"], table["iterations"], strict=True))
    return sorted({learner for learner, _ in needed - shipped})


class Tuned:
    """Settings of a study: rows of setup 0 in files with the format of the campaign's table."""

    def __init__(self, study: Study, files: Iterable[Path]):
        self._study = study
        table = pd.concat(map(pd.read_csv, files)).query("setup == 0 and replicate == 0")
        self._rows = table.drop_duplicates(["variant", "iterations"], keep="last").set_index(
            ["variant", "iterations"]
        )

    def learner(self, name: str, iterations: int, runs: int) -> HierarchicalLearner:
        """An untrained learner for several runs. Raises RecalibError if there are no settings."""
        rules = rules_of(self._study.every_learner[name])
        if (name, iterations) not in self._rows.index:
            raise RecalibError(f"no settings of {name} for {iterations} iterations; try: make tune")
        space = Space(rules, self._study.search.ranges)
        row = self._rows.loc[(name, iterations), space.columns].to_numpy(dtype=float)
        return HierarchicalLearner(rules, space.schedule(np.tile(row, (runs, 1))), runs=runs)
