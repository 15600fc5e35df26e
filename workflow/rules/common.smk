"""The studies of this call, checked before anything runs, and what all rules share."""

import os
import sys
from pathlib import Path

from snakemake.exceptions import WorkflowError
from snakemake.persistence import PersistenceBase

ROOT = Path(workflow.basedir)
# The project's own modules, also where another copy of it is installed, and how a job starts; and
# one core for each: without this, the linear algebra of every job starts a thread for each core of
# the machine.
sys.path.insert(0, str(ROOT))
os.environ["PYTHONPATH"] = os.pathsep.join([str(ROOT), str(ROOT / "workflow" / "start")])
os.environ.update(OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")
# The same last digits on every processor with AVX2: otherwise NumPy and its linear algebra take
# other loops on newer ones, and a search ends elsewhere where a likelihood is flat.
processor = Path("/proc/cpuinfo")
if processor.exists() and "avx2" in processor.read_text(encoding="utf-8"):
    os.environ["NPY_DISABLE_CPU_FEATURES"] = "X86_V4 AVX512_ICL AVX512_SPR"
    os.environ["OPENBLAS_CORETYPE"] = "Haswell"

# Snakemake asks of every parameter whether it is a table, and brings pandas for that, which takes
# longer than all else here. Ours are text.
PersistenceBase._serialize_param_pandas = PersistenceBase._serialize_param_builtin

from pydantic_core import to_json

from recalib.errors import RecalibError
from recalib.study.nominal import nominal
from recalib.study.shipped import RESULTS, SEARCHED
from recalib.study.studies import ask_robots, read_studies
from recalib.study.trainings import Trainings, measuring, searches, seeds
from recalib.study.trainings import rules as rules_of
from workflow.dependencies import calls

try:
    # by the folder of their results: the shipped one, those of workflow/studies, and this call's
    settings = workflow.config_settings
    MAIN, STUDIES = read_studies(
        ROOT, settings.configfiles, settings.config, asking=workflow.is_main_process
    )
except RecalibError as error:
    raise WorkflowError(str(error)) from None

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
    recording=r"\w+(-\w+)?(\.today)?",
    robot=r"\w+",
    learner=r"\w+",
    chunk=r"\d+",
    batch=r"\d+",
    series=r"[a-z]+",
    figure=r"\w+",
    training=r"\w+_\d+",
