"""Entry point of `python -m recalib`, the same as the command `recalib`."""

import sys

from recalib.laboratory.command_line import main

if __name__ == "__main__":
    sys.exit(main())
