"""What every script of the workflow does around its work."""

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager

from recalib.errors import RecalibError


@contextmanager
def job(snakemake) -> Iterator[None]:
    """Say at the end what was made and how long it took; show an error of recalib as a line."""
    start = time.perf_counter()
    try:
        yield
    except RecalibError as error:
        sys.exit(f"{snakemake.rule}: {error}")
    made = snakemake.output[0] if len(snakemake.output) else snakemake.rule
    print(f"{snakemake.rule}: made {made} in {time.perf_counter() - start:.1f} s", file=sys.stderr)
