"""Make config.yaml, as it now is, the shipped study: `make ship`."""

from pathlib import Path

from recalib.study.studies import ship

if __name__ == "__main__":
    ship(Path.cwd())
