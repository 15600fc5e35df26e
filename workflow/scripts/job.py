"""What every script of the workflow does around its work."""

import signal
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager

from recalib.errors import RecalibError
from workflow.digests import check, keep


@contextmanager
def job(snakemake) -> Iterator[None]:
    """Check what is read, note what was written, and say how long it took.

    An error of recalib or of the system, or an interrupt, is shown as a line.
    """
    start = time.perf_counter()
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        check(snakemake.input)
        yield
        keep(snakemake.output)
    except (RecalibError, OSError) as error:
        sys.exit(f"{snakemake.rule}: {error}")
    except KeyboardInterrupt:
        sys.exit(f"{snakemake.rule}: interrupted")
    finally:
        signal.signal(signal.SIGINT, before)
    made = snakemake.output[0] if len(snakemake.output) else snakemake.rule
    print(f"{snakemake.rule}: made {made} in {time.perf_counter() - start:.1f} s", file=sys.stderr)
