"""`python -m tests.faults` tries every fault and prints a table; `make faults` does."""

import argparse
import signal
import sys
import tempfile
import time
from pathlib import Path

from tests.faults.faults import FAULTS, SHORT
from tests.faults.yard import NotTried, Yard
from tests.project import Broken


def main() -> int:
    """Try faults, and say of each whether it was survived and how; 1 if one was not."""
    parser = argparse.ArgumentParser(prog="python -m tests.faults", description=__doc__)
    parser.add_argument("--short", action="store_true", help="those that take little time")
    parser.add_argument("--cores", type=int, default=2, help="of each run")
    parser.add_argument(
        "--only", nargs="+", default=[""], help="those with such a word in their name"
    )
    chosen = parser.parse_args()
    list_ = SHORT if chosen.short else FAULTS
    names = [name for name in list_ if any(word in name for word in chosen.only)]
    # what is begun in the background ignores Ctrl-C, and so would all runs
    signal.signal(signal.SIGINT, signal.default_int_handler)
    broken, missing = [], 0
    print("| tried | survived | how | s |\n| --- | --- | --- | --- |", flush=True)
    with tempfile.TemporaryDirectory(prefix="faults") as folder:
        yard = Yard(Path(folder), chosen.cores)
        yard.expected  # noqa: B018 before the clock starts
        for name in names:
            start = time.monotonic()
            try:
                how, well = FAULTS[name](yard), "yes"
            except NotTried as reason:
                how, well, missing = str(reason), "not tried", missing + 1
            except Broken as error:
                how, well = f"expected: {error}", "**no**"
                broken.append(f"## {name}\n{error.said}")
            print(f"| {name} | {well} | {how} | {time.monotonic() - start:.0f} |", flush=True)
    asked = len(names) - missing
    print(f"\n{asked - len(broken)} of {asked} survived", *broken, sep="\n\n")
    return bool(broken)


if __name__ == "__main__":
    sys.exit(main())
