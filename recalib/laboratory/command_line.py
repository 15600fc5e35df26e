"""The command line of `recalib`; see docs/own_arm.md, pictures.md, poses.md and live.md."""

import io
import os
import sys
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from recalib import laboratory
from recalib.errors import RecalibError
from recalib.files.outputs import check_new, is_taken
from recalib.laboratory.options import DONE, NO_BETTER, REFUSED, parse

__all__ = ["DONE", "NO_BETTER", "REFUSED", "main"]
CACHE = "MPLCONFIGDIR"  # the environment variable that names Matplotlib's folder


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command and return its exit code. An error is one sentence on stderr."""
    options = parse(sys.argv[1:] if arguments is None else arguments)
    # NumPy reads this on import. With matrices this small, threads mostly wait for each other:
    # on a busy machine, several take ten times as long as one.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")  # names may be outside its encoding
    try:
        check_new(options.out, options.folder)
        with _no_cache_at_home():
            # imported only now, so that help and refusals do not wait for Pinocchio and SciPy
            return int(getattr(laboratory.commands, options.command)(options))
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
        complete = is_taken(options.out, options.folder)
        message = f"interrupted; {options.out} is {'complete' if complete else 'not written'}"
    print(f"recalib: {message}", file=sys.stderr)
    return REFUSED


@contextmanager
def _no_cache_at_home() -> Iterator[None]:
    """Keep Matplotlib's font cache in a temporary folder, unless the user has set a folder.

    A command writes nothing but its output. Building the cache takes a fraction of a second.
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
