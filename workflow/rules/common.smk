"""The study of this call, checked before anything runs, and functions for all rules."""

import os
import sys
from pathlib import Path

ROOT = Path(str(workflow.current_basedir)).parents[1]  # also if another workflow uses this one
sys.path.insert(0, str(ROOT))

from replication.running.environment import prepare

prepare(ROOT)  # before NumPy is imported

from snakemake.exceptions import WorkflowError

from recalib.errors import RecalibError
from replication.config.shipped import SHIPPED, root_of
from replication.running.alone import check_known, check_writable, hold
from replication.running.layers import digest
from replication.running.studies import study_of

try:
    STUDY = study_of(
        ROOT,
        workflow.config_settings.configfiles,
        workflow.config_settings.config,
        asking=workflow.is_main_process,
    )
    RESULTS = root_of(STUDY.name)
    check_writable(".snakemake")
    check_known(RESULTS)
except RecalibError as error:
    sys.exit(str(error))  # for an exception, Snakemake would blame this file and line

IS_SHIPPED = STUDY.name == SHIPPED
DUMPED = STUDY.model_dump_json()


def calls(function):
    """Params of a rule that calls "module:function" of `replication`; its code triggers a rerun."""
    return {
        "function": f"replication.{function}",
        "study": DUMPED,
        "code": digest(f"replication.{function.split('.')[0]}"),
    }


def room(mem_mb, runtime):
    """Memory [MB] and time [min] that a job may use on a cluster; more after each failure."""
    return {
        "mem_mb": lambda wildcards, attempt: mem_mb * attempt,
        "runtime": lambda wildcards, attempt: runtime * attempt,
    }


onstart:
    try:
        hold(RESULTS)
    except RecalibError as error:
        raise WorkflowError(str(error)) from None
