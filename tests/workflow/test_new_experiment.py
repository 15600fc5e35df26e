"""The page on architecture shows how an experiment comes in: its files, run as they stand there."""

import json
import re

import pandas as pd
import pytest
import yaml

from tests.conftest import ROOT
from tests.project import Project
from tests.workflow.conftest import CORES

BLOCK = re.compile(r"```python\n# (\S+)\n(.*?)```", re.DOTALL)
EXAMPLE = BLOCK.findall((ROOT / "docs" / "architecture.md").read_text(encoding="utf-8"))


def put(path, block: str) -> None:
    """A new file, or more of one: lines that are there already say where the others come."""
    there = path.read_text(encoding="utf-8") if path.exists() else ""
    lines = block.splitlines(keepends=True)
    known = next(n for n in range(len(lines), -1, -1) if "".join(lines[:n]) in there)
    begun = "".join(lines[:known]).strip() and "".join(lines[:known])
    path.write_text(there.replace(begun, block, 1) if begun else there + block, encoding="utf-8")


def test_it_takes_four_files():
    assert len({path for path, _ in EXAMPLE}) == 4


@pytest.mark.slow
def test_the_example_is_measured_and_judged(tmp_path):
    project = Project(tmp_path, *CORES, "--configfile", "example.yaml", name="example")
    for path, block in EXAMPLE:
        put(tmp_path / path, block)
    tiny = yaml.safe_load((ROOT / "tests" / "tiny.yaml").read_text(encoding="utf-8"))
    tiny |= {"name": "example", "mapping": {"poses": 7}}
    tiny["experiments"] |= {"scenarios": ["intact"], "learners": ["improved"]}
    (tmp_path / "example.yaml").write_text(yaml.safe_dump(tiny), encoding="utf-8")
    results = project.results

    def run():
        project.run("--", "results/studies/example/claims.json").well()
        claims = {its["id"]: its for its in json.loads((results / "claims.json").read_text())}
        return pd.read_csv(results / "singularities.csv")["condition"], claims

    conditions, claims = run()
    judged = claims["far-from-singularities"]
    assert len(conditions) == 7 and judged["verdict"] == "supported"
    assert judged["measured"]["median condition number"] == pytest.approx(conditions.median(), 1e-4)
    (tmp_path / "example.yaml").write_text(yaml.safe_dump(tiny | {"mapping": {"poses": 8}}))
    assert len(run()[0]) == 8
