"""The only script of the workflow: it calls a rule's function, and writes the returned values.

The function gets the study, the rule's `params`, and the paths of inputs and outputs as arguments,
if its signature has their names. Returned values are written to those outputs that are not
arguments.
"""

import atexit
import inspect
import os
import sys
import time
from collections.abc import Callable
from pathlib import Path
from pkgutil import resolve_name
from typing import Any

from pydantic import ConfigDict, validate_call
from snakemake.script import Snakemake

from recalib.errors import RecalibError
from replication.config.study import Study
from replication.running.result_files import write


def main(job: Snakemake) -> None:
    """Do the job of a rule. Mistakes of users and errors of the system are reported in one line."""
    function: Callable[..., Any] = resolve_name(job.params.function)
    parameters = inspect.signature(function).parameters
    files = {**dict(job.input.items()), **dict(job.output.items())}
    arguments = {name: path for name, path in files.items() if name in parameters}
    arguments |= {name: value for name, value in job.params.items() if name in parameters}
    if "study" in parameters:
        arguments["study"] = Study.model_validate_json(job.params.study)
    outputs = dict(job.output.items()) or {"": job.output[0]}
    paths = [path for name, path in outputs.items() if name not in parameters]
    start = time.perf_counter()
    try:
        call = validate_call(config=ConfigDict(arbitrary_types_allowed=True))(function)
        returned = call(**arguments)
        values = [returned] if len(paths) == 1 else returned or ()
        for path, value in zip(paths, values, strict=True):
            write(Path(path), value, job.params.get("digits"))
    except (RecalibError, OSError) as error:
        sys.exit(f"{job.rule}: {error}")
    seconds = time.perf_counter() - start
    print(f"{job.rule}: made {job.output[0]} in {seconds:.1f} s", file=sys.stderr)


def into(log: Path) -> None:
    """Write the job's output into its log, and the log to the terminal when the job ends."""
    terminal = os.dup(2)
    with log.open("wb") as file:
        os.dup2(file.fileno(), 1)
        os.dup2(file.fileno(), 2)
    # exit handlers run after Python has printed a traceback
    atexit.register(lambda: os.write(terminal, log.read_bytes()))


snakemake: Snakemake  # defined when Snakemake runs this script
if "snakemake" in globals():
    into(Path(snakemake.log[0]))
    main(snakemake)
