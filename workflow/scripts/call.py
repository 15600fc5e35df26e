"""The one script of the workflow: it calls the function that a rule names, and writes what that
returns.

A function gets the arguments that the rule's `params` give; the paths of inputs and of outputs it
gets by their names, where it asks for them. It writes by itself the outputs whose paths it asks
for. What it returns is written into the others, by their suffix.
"""

import inspect
import json
import os
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from typing import Any

from recalib.errors import RecalibError
from recalib.files.storage import whole
from workflow.digests import check, keep


def run(snakemake) -> None:
    """Do the job of a rule."""
    module, _, name = snakemake.params.function.rpartition(".")
    function = getattr(import_module(module), name)
    with job(snakemake):
        asked = inspect.signature(function).parameters
        outputs = dict(snakemake.output.items()) or {"": snakemake.output[0]}
        left = [path for output, path in outputs.items() if output not in asked]
        files = {**dict(snakemake.input.items()), **outputs}
        given = json.loads(snakemake.params.get("arguments", "{}"))
        paths = {file: path for file, path in files.items() if file in asked and path}
        returned = function(**checked(function, dict(**given, **paths)))
        values = [returned] if len(left) == 1 else returned or ()
        for path, value in zip(left, values, strict=True):
            write(Path(path), value, snakemake.params.get("digits"))


def checked(function: Callable, given: Mapping) -> dict[str, Any]:
    """Arguments of a function in the types of its signature. Raises pydantic's ValidationError."""
    from pydantic import create_model

    fields = {
        name: (its.annotation, ... if its.default is its.empty else its.default)
        for name, its in inspect.signature(function).parameters.items()
    }
    arguments = create_model(function.__name__, __config__={"extra": "forbid"}, **fields)
    typed = arguments.model_validate_json(json.dumps(given))
    return {name: getattr(typed, name) for name in fields}


def write(path: Path, value: Any, digits: int | None = None) -> None:
    """Write a table, a value or a text, whole or not at all.

    Args:
        digits: of the numbers in a table of text; all that they have unless given.
    """
    with whole(path) as temporary:
        match path.suffix:
            case ".parquet":
                import pyarrow as pa
                import pyarrow.parquet as pq

                if hasattr(value, "to_parquet"):
                    value.to_parquet(temporary, index=False)
                else:
                    pq.write_table(pa.table(value) if isinstance(value, dict) else value, temporary)
            case ".csv" if not isinstance(value, str):
                import pandas as pd

                decimals = f"%.{digits}g" if digits else None
                pd.DataFrame(value).to_csv(temporary, index=False, float_format=decimals)
            case ".json":
                plain = value.model_dump(mode="json") if hasattr(value, "model_dump") else value
                temporary.write_text(json.dumps(plain, indent=2) + "\n", encoding="utf-8")
            case _:
                temporary.write_text(value, encoding="utf-8")


@contextmanager
def logged(path: Path) -> Iterator[None]:
    """Write what a job prints into its log, and then on the terminal.

    Where it fails, Snakemake shows the log.
    """
    terminal = os.dup(2)
    with path.open("wb") as log:
        os.dup2(log.fileno(), 1)
        os.dup2(log.fileno(), 2)
    yield
    sys.stdout.flush()
    sys.stderr.flush()
    os.write(terminal, path.read_bytes())


@contextmanager
def job(snakemake) -> Iterator[None]:
    """Check what is read, note what was written, and say how long it took.

    An error of recalib or of the system is shown as a line.
    """
    start = time.perf_counter()
    try:
        check(snakemake.input)
        yield
        keep(snakemake.output)
    except (RecalibError, OSError) as error:
        sys.exit(f"{snakemake.rule}: {error}")
    made = snakemake.output[0] if len(snakemake.output) else snakemake.rule
    print(f"{snakemake.rule}: made {made} in {time.perf_counter() - start:.1f} s", file=sys.stderr)


if "snakemake" in globals():
    with logged(Path(snakemake.log[0])):
        run(snakemake)
