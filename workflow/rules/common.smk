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

from recalib.errors import RecalibError
from recalib.study.layout import RESULTS, SEARCHED, Layout
from recalib.study.plan import Plan
from recalib.study.studies import ask_robots, read_studies
from recalib.study.trainings import Trainings
from workflow.dependencies import made_from

try:
    # by the folder of their results: the shipped one, those of workflow/studies, and this call's
    settings = workflow.config_settings
    MAIN, STUDIES = read_studies(
        ROOT, settings.configfiles, settings.config, asking=workflow.is_main_process
    )
except RecalibError as error:
    raise WorkflowError(str(error)) from None

LAYOUT = Layout("{root}")  # of rules, in which the folder is a wildcard
TRAININGS = {root: Trainings(each) for root, each in STUDIES.items()}
PLANS = {root: Plan(each) for root, each in STUDIES.items()}


def layout(wildcards):
    """The paths of the study that a job belongs to."""
    return Layout(wildcards.root)


def study(wildcards):
    """The study that a job belongs to."""
    return STUDIES[wildcards.root]


def plan(wildcards):
    """What each job of a study needs."""
    return PLANS[wildcards.root]


def as_text(job):
    """A job as a parameter that Snakemake tracks: of all types it tracks only the built-in ones."""
    return job.model_dump_json()


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
