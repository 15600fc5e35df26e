"""How long a run will still take: said now and then, as if the jobs left took as long as others."""

import logging
import sys
import time

from snakemake_interface_logger_plugins.common import LogEvent

EVERY = 30.0  # s between two lines


class TimeLeft(logging.Handler):
    """Says the time left, at most twice a minute, where Snakemake logs how many jobs are done."""

    def __init__(self) -> None:
        super().__init__()
        self._start = self._said = time.monotonic()

    def emit(self, record: logging.LogRecord) -> None:
        its, now = vars(record), time.monotonic()
        if its.get("event") != LogEvent.PROGRESS:
            return
        done, total = its["done"], its["total"]
        if done in (0, total) or now - self._said < EVERY:
            return
        self._said = now
        minutes = (now - self._start) * (total - done) / done / 60
        left = f"{minutes:.0f} min" if minutes >= 1.5 else "a minute"
        print(f"{done} of {total} jobs done, about {left} left", file=sys.stderr)
