"""The viewer's program, which writes nothing into a home and tells nobody of its use."""

import os
from pathlib import Path

import rerun_cli

# Not the script that starts it, so that it can be ended.
PROGRAM = Path(rerun_cli.__file__).with_name("rerun")


def quiet() -> dict[str, str]:
    """The environment in which it neither notes who runs it nor sends that anywhere.

    It has no setting for this but a file in the home; where nobody looks on, it does neither.
    """
    return os.environ | {"CI": "true"}
