"""Learners by name, with the rules of their entry in the configuration and the settings that the search found."""

import re
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import yaml

from recalib.errors import InvalidSetting, UnknownName
from recalib.learners.hierarchical import HierarchicalLearner, Rules
from recalib.study.experiments import search


class Training(NamedTuple):
    """A learner's entry in the configuration and the number of iterations that it is trained for."""

    name: str
    iterations: int

    def __str__(self) -> str:
        return f"{self.name}_{self.iterations}"


def training(learner: str, learners: Mapping) -> Training:
    """What `NAME` or `NAME_ITERATIONS` means. Raises UnknownName."""
    if learner in learners:
        return Training(learner, learners[learner]["iterations"])
    match = re.fullmatch(r"(\w+)_([1-9]\d*)", learner)
    if match is None or match[1] not in learners:
        raise UnknownName(
            "learner", learner, [*learners, *(f"{name}_ITERATIONS" for name in learners)]
        )
    return Training(match[1], int(match[2]))


def rules(entry: Mapping) -> Rules:
    """The rules that a learner's entry in the configuration describes."""
    return Rules(
        separate_maps=entry["maps"] == "separate",
        theta_increments=entry["theta"] == "increments",
        jacobian_increments=entry["jacobian"] == "increments",
        equal_visits=entry["schedule"] == "equal_visits",
        supernet=tuple(entry["supernet"]),
        subnet=tuple(entry["subnet"]),
    )


def settings(which: Training, folder: str | Path) -> dict[str, float]:
    """The best trial of the search for this training. Raises InvalidSetting where there was no search for it."""
    path = Path(folder) / "settings.yaml"
    found = yaml.safe_load(path.read_text()) if path.exists() else {}
    if str(which) not in found:
        valid = f"one that was searched for ({', '.join(found)}), or run `snakemake --cores 2 tune` after adding it"
        raise InvalidSetting("learner", str(which), valid)
    return found[str(which)]


def build(which: Training, runs: int, learners: Mapping, folder: str | Path) -> HierarchicalLearner:
    """The learner of a training, untrained, with the settings that were found for it."""
    its_rules = rules(learners[which.name])
    return HierarchicalLearner(runs, its_rules, search.schedule(settings(which, folder), its_rules))
