"""The rules of the workflow, read once: what they hand to functions, for any study."""

import inspect
import json
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path

from snakemake.api import SnakemakeApi
from snakemake.iocontainers import Wildcards
from snakemake.settings.types import OutputSettings, Quietness, ResourceSettings

from replication.training.trainings import Trainings
from tests.conftest import ROOT
from workflow.scripts.call import checked


def function_of(rule):
    """The function that a rule calls."""
    module, _, name = rule.params.function.rpartition(".")
    return getattr(import_module(module), name)


class Rules:
    """The rules, as the Snakefile in a folder has them."""

    def __init__(self, folder: Path = ROOT):
        with self.reading(folder) as api:
            self.workflow = api._workflow
        self.names = self.workflow.globals

    @staticmethod
    @contextmanager
    def reading(folder: Path):
        with SnakemakeApi(OutputSettings(quiet={Quietness.ALL})) as api:
            resources = ResourceSettings(cores=1)
            yield api.workflow(resources, snakefile=folder / "Snakefile", workdir=folder)

    def become(self, studies):
        """From now on, these are the studies, by folder of results."""
        self.names["STUDIES"].update(studies)
        self.names["TRAININGS"].update({root: Trainings(its) for root, its in studies.items()})
        self.names["sample_at"].cache_clear()
        self.names["recording_of"].cache_clear()

    def text(self, study, rule: str, **wildcards: object) -> str:
        """The arguments of a job, as Snakemake tracks them."""
        self.become({"results": study})
        wildcards = Wildcards(fromdict={"root": "results"} | wildcards)
        its = self.workflow.get_rule(rule).params
        return its.arguments(wildcards) if "arguments" in its.keys() else "{}"  # noqa: SIM118

    def arguments(self, study, rule: str, **wildcards: object) -> dict:
        """The arguments of a job, as its function gets them: without the paths of files."""
        given = json.loads(self.text(study, rule, **wildcards))
        function = function_of(self.workflow.get_rule(rule))
        parameters = inspect.signature(function).parameters
        asked = {name for name, its in parameters.items() if its.default is its.empty}
        missing = asked - {*given}
        lists = {name for name in missing if "list" in str(parameters[name].annotation)}
        paths = {name: [] if name in lists else "" for name in missing}
        typed = checked(function, paths | given)
        return {name: value for name, value in typed.items() if name in given}
