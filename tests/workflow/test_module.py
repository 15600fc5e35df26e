"""Another workflow can use this one as a module, as docs/bend.md says."""

import re
import subprocess
import sys

import pytest

from tests.conftest import ROOT, copy_project


@pytest.mark.slow
def test_the_rules_are_planned_from_another_workflow(tmp_path):
    page = (ROOT / "docs" / "bend.md").read_text(encoding="utf-8")
    (snakefile,) = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    (tmp_path / "Snakefile").write_text(snakefile)
    (tmp_path / "recalib").mkdir()
    copy_project(tmp_path / "recalib")
    command = [sys.executable, "-m", "snakemake", "--dry-run", "--quiet", "host"]
    planned = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert planned.returncode == 0, planned.stderr
    assert "recalibration_findings" in planned.stdout + planned.stderr
