"""The studies of this call, checked before anything runs, and what all rules share."""

import sys
from pathlib import Path

ROOT = Path(workflow.basedir)
sys.path.insert(0, str(ROOT))

from workflow.environment import prepare

prepare(ROOT)  # before NumPy is imported


from pydantic_core import to_json
from snakemake.logging import logger

from recalib.errors import RecalibError
from replication.scenarios.nominal import nominal
from replication.config.shipped import RESULTS, SEARCHED
from replication.running.studies import ask_robots, read_studies
from replication.training.trainings import Trainings, measuring, searches, seeds
from replication.training.trainings import rules as rules_of
from workflow.dependencies import calls
from workflow.time_left import TimeLeft

try:
    # by the folder of their results: the shipped one, those of workflow/studies, and this call's
    settings = workflow.config_settings
    MAIN, STUDIES = read_studies(
        ROOT, settings.configfiles, settings.config, asking=workflow.is_main_process
    )
except RecalibError as error:
    sys.exit(str(error))  # an exception would be told with this file and line, where no mistake is

if workflow.is_main_process:
    logger.addHandler(TimeLeft())

TRAININGS = {root: Trainings(each) for root, each in STUDIES.items()}


def study(wildcards):
    """The study that a job belongs to."""
    return STUDIES[wildcards.root]


def as_text(**arguments):
    """Arguments of a function as Snakemake tracks them: of all types, only the built-in ones."""
    return to_json(arguments).decode()


def room(mem_mb, runtime):
    """Memory [MB] and time [min] that a job may take on a cluster; more each time it is retried."""
    return {
        "mem_mb": lambda wildcards, attempt: mem_mb * attempt,
        "runtime": lambda wildcards, attempt: runtime * attempt,
    }


wildcard_constraints:
    root="|".join(STUDIES),
    scenario=r"\w+(-\w+)?",
    recording=r"\w+(-\w+)?",
    robot=r"\w+",
    learner=r"\w+",
    chunk=r"\d+",
    series=r"[a-z]+",
    figure=r"\w+",
    training=r"\w+_\d+",
