"""The command line: `recalib calibrate` and others; docs/own_arm.md, pictures.md and live.md."""

import io
import os
import sys
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib import import_module

from recalib.errors import RecalibError
from recalib.files.outputs import check_new, is_taken
from recalib.laboratory.options import DONE, NO_BETTER, REFUSED, parse

__all__ = ["DONE", "NO_BETTER", "REFUSED", "main"]
CACHE = "MPLCONFIGDIR"  # the environment variable with Matplotlib's folder


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command, and return its exit code. A mistake is one sentence on stderr."""
    options = parse(sys.argv[1:] if arguments is None else arguments)
    # NumPy reads it when it is imported. Of matrices so small, each thread would wait for others:
    # where something else is at work, ten times as long as it takes one alone.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")  # names may have letters that it lacks
    try:
        check_new(options.out, options.folder)
        with _no_cache_at_home():
            # imported when one was chosen: help and refusals need not wait for Pinocchio and SciPy
            command = getattr(import_module("recalib.laboratory.commands"), options.command)
            return int(command(options))
    except RecalibError as error:
        message = str(error)
    except OSError as error:
        message = f"{error.filename}: {error.strerror}" if error.filename else str(error)
    except ModuleNotFoundError as error:
        package = (error.name or "").partition(".")[0]
        message = f"{package} is missing; try: pip install 'recalib[laboratory,vision]'"
    except MemoryError:
        message = "there is not enough memory for this; try: fewer rows"
    except KeyboardInterrupt:
        there = is_taken(options.out, options.folder)
        message = f"interrupted; {options.out} is {'complete' if there else 'not written'}"
    print(f"recalib: {message}", file=sys.stderr)
    return REFUSED


@contextmanager
def _no_cache_at_home() -> Iterator[None]:
    """Have Matplotlib keep its list of fonts in a folder that is removed, unless one is set.

    A command writes nothing but its output. Making the list takes a fraction of a second.
    """
    if CACHE in os.environ:
        yield
        return
    with tempfile.TemporaryDirectory(prefix="recalib-") as folder:
        os.environ[CACHE] = folder
        try:
            yield
        finally:
            del os.environ[CACHE]
