"""Says why a file is not a study: `python -m replication.running.readable FILE`.

Snakemake reads the file before the project does, and names no file when it cannot.
"""

import sys

from replication.config.messages import InvalidConfiguration
from replication.config.values import from_file


def main(file: str) -> None:
    """End with the reason if a file has no keys with values."""
    try:
        from_file(file)
    except InvalidConfiguration as error:
        sys.exit(str(error))


if __name__ == "__main__":
    main(*sys.argv[1:])
