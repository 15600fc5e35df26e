"""What a result depends on: every leaf of the configuration is changed, one at a time.

The workflow is read once. For each change, inputs and parameters of all its jobs are asked for
again, as Snakemake would: where they differ, the job runs again, and all that follows from it.
"""

import copy
import itertools
import re
from fnmatch import fnmatch
from pathlib import Path

import pytest
import yaml
from snakemake.api import SnakemakeApi
from snakemake.settings.types import DAGSettings, OutputSettings, Quietness, ResourceSettings

from recalib.study.configuration.study import Study
from recalib.study.plan import Plan
from recalib.study.trainings import Trainings
from tests.conftest import ROOT, copy_project

# What has to run again by itself when a leaf changes, by patterns of paths; all that match count.
# `all` stands for the list of what a study consists of. What follows from these runs again, too.
DEPENDS = {}


def leaves(tree, path=()):
    """Paths of all leaves: a list of words is one, a list of numbers or quantities as many."""
    if isinstance(tree, dict):
        for key, value in tree.items():
            yield from leaves(value, (*path, key))
    elif isinstance(tree, list) and any(isinstance(each, dict) for each in tree):
        for index, value in enumerate(tree):
            yield from leaves(value, (*path, index))
    else:
        yield path


def at(tree, path):
    for key in path:
        tree = tree[key]
    return tree


QUANTITY = re.compile(r"([-+]?[\d.]+) (mm|cm|m|deg|rad|rad/Nm)")
OTHERS = {
    "maps": {"single": "separate", "separate": "single"},
    "theta": {"values": "increments", "increments": "values"},
    "jacobian": {"values": "increments", "increments": "values"},
    "schedule": {"exponential": "equal_visits", "equal_visits": "exponential"},
    "assigned": {"links": "encoders", "encoders": "links"},
    "settings": {"shipped": "own", "own": "shipped"},
    "robot": {"ur10": "ur5", "ur5": "ur10"},
    "scenario": {"links_encoders": "links"},
}


def changes(path, value):
    """Other values for a leaf, until one of them makes a difference."""
    if isinstance(value, bool):
        yield not value
    elif isinstance(value, int):
        yield from (value + 1, 2 * value, max(value // 3, 1))
    elif isinstance(value, float):
        yield 1.01 * value
    elif value is None:
        yield "a_copy.csv"
    elif isinstance(value, str):
        if match := QUANTITY.fullmatch(value):
            yield f"{1.5 * float(match[1]) + 0.5:g} {match[2]}"
        elif path[-1] in OTHERS:
            yield OTHERS[path[-1]][value]
        elif path[-1] == "sha256":
            yield value[::-1]
        else:
            yield f"{value}_changed"
    elif isinstance(value, list) and value:
        first = next(changes((*path, 0), value[0]))
        yield value[1:] if isinstance(value[0], str) and not QUANTITY.fullmatch(value[0]) else [
            first,
            *value[1:],
        ]
        yield value[:-1]


class Workflow:
    """The workflow with these targets, read once.

    Attributes:
        jobs: (rule, wildcards) of all its jobs.
    """

    def __init__(self, folder, targets):
        output = OutputSettings(quiet={Quietness.ALL})
        with SnakemakeApi(output) as api:
            its = api.workflow(ResourceSettings(cores=1), snakefile=folder / "Snakefile", workdir=folder)
            its.dag(DAGSettings(targets=set(targets)))
            workflow = its._workflow
            workflow._prepare_dag(forceall=True, ignore_incomplete=True, lock_warn_only=True)
            workflow._build_dag()
            self.jobs = [(job.rule, job.wildcards_dict) for job in workflow.dag.jobs]
        self.names = workflow.globals
        self.studies = dict(self.names["STUDIES"])

    def with_studies(self, studies):
        """Inputs and parameters of every job, by rule and wildcards, were these the studies."""
        self.names["STUDIES"].update(studies)
        for root, study in studies.items():
            self.names["PLANS"][root] = Plan(study)
            self.names["TRAININGS"][root] = Trainings(study)
        self.names["sample_at"].cache_clear()
        return {
            (rule.name, *wildcards.values()): self._asks(rule, wildcards)
            for rule, wildcards in self.jobs
        }

    def _asks(self, rule, wildcards):
        try:
            inputs, *_ = rule.expand_input(wildcards)
            outputs, *_ = rule.expand_output(wildcards)
            params, _ = rule.expand_params(wildcards, inputs, outputs, None)
        except Exception as error:  # a job that no longer makes sense is one that has changed
            return repr(error)
        return sorted(map(str, inputs)), repr(params)
