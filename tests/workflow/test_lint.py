"""`snakemake --lint` finds nothing but what is meant."""

import re
import subprocess
import sys

from tests.conftest import ROOT

MEANT = {
    "Specify a conda environment": "requirements.lock is the environment of all rules",
    "Mixed rules and functions": "what finds the inputs of one rule stands beside it",
}


def test_the_workflow_is_clean():
    command = [sys.executable, "-m", "snakemake", "--lint"]
    linted = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    titles = re.findall(r"^    \* (.*?):$", linted.stdout + linted.stderr, re.MULTILINE)
    assert titles
    assert [title for title in titles if not title.startswith(tuple(MEANT))] == []
