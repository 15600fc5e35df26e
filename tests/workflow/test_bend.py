"""A study of one's own: as docs/bend.md has it, by the commands that the page names."""

import os
import re
import sys
from subprocess import CompletedProcess

import pytest

from replication.running import study_of
from replication.training import Place, places
from tests.conftest import ROOT, copy_project, run
from tests.faults.project import Project

PAGE = (ROOT / "docs" / "bend.md").read_text(encoding="utf-8")
STUDY = re.search(r"```yaml\n(.*?)```", PAGE, re.DOTALL)[1]


def make(folder, *arguments) -> CompletedProcess:
    """What make would do."""
    return run("make", "-n", "-o", "setup", *arguments, cwd=folder)


@pytest.fixture
def project(with_studies):
    (with_studies / "my_arm.yaml").write_text(STUDY, encoding="utf-8")
    return with_studies


def test_ten_lines_are_enough_for_another_robot_with_another_damage(project):
    assert len(STUDY.splitlines()) <= 10
    mine = study_of(project, [project / "my_arm.yaml"])
    assert (mine.name, mine.robot, mine.scenario) == ("my_arm", "ur5", "fall")
    assert mine.expected is None, "bands belong to the study that has them"
    assert [*places(mine)] == [Place("ur5", "fall")]
    row = next(line for line in PAGE.splitlines() if line.startswith("| `like` |"))
    studies = {path.stem for path in (ROOT / "workflow" / "studies").glob("*.yaml")}
    assert len(studies) > 4 and studies <= {*re.findall(r"\w+", row)}


@pytest.mark.parametrize(
    ("command", "planned"),
    [
        ("study STUDY=my_arm", "snakemake --cores 2 --configfile my_arm.yaml --quiet"),
        ("view STUDY=my_arm", "127.0.0.1 --new results/studies/my_arm/recordings/fall.rrd"),
        ("web STUDY=my_arm", "--directory results/studies/my_arm/web 9090"),
    ],
)
def test_a_command_speaks_of_its_study(project, command, planned):
    recording = project / "results/studies/my_arm/recordings/fall.rrd"
    recording.parent.mkdir(parents=True)
    recording.touch()
    assert planned in make(project, *command.split()).stdout


def test_a_study_without_a_file_is_refused(project):
    refused = make(project, "study", "STUDY=my_leg")
    assert refused.returncode and "there is no my_leg.yaml" in refused.stderr


def test_a_file_that_snakemake_cannot_read_is_named(project):
    (project / "my_leg.yaml").write_text("robot: [ur5\n", encoding="utf-8")
    message = (
        "2:1: invalid YAML: expected ',' or ']', but got '<stream end>' in the part from line 1"
    )
    commands = make(project, "study", "STUDY=my_leg").stdout
    reading, here = "-m replication.config.reading", os.environ | {"PYTHONPATH": str(ROOT)}
    assert f"{reading} my_leg.yaml\n" in commands
    for name, says in (("my_leg.yaml", f"my_leg.yaml:{message}\n"), ("my_arm.yaml", "")):
        read = run(sys.executable, *reading.split(), name, cwd=project, env=here)
        assert read.stderr == says


@pytest.mark.slow
def test_a_study_is_refused_with_its_mistakes_alone(tmp_path):
    (tmp_path / "my_leg.yaml").write_text("like: quick\nrobot: kuka\n", encoding="utf-8")
    outcome = Project(tmp_path, "--configfile", "my_leg.yaml").run("--dry-run")
    *_, last = outcome.expect_failure().output.splitlines()
    assert last.startswith("my_leg.yaml:2:1: robot is 'kuka'; expected: ur10")


@pytest.mark.slow
def test_the_rules_are_planned_from_another_workflow(tmp_path):
    page = (ROOT / "docs" / "bend.md").read_text(encoding="utf-8")
    (snakefile,) = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    (tmp_path / "Snakefile").write_text(snakefile)
    (tmp_path / "recalib").mkdir()
    copy_project(tmp_path / "recalib")
    command = sys.executable, "-m", "snakemake", "--dry-run", "--quiet", "host"
    planned = run(*command, cwd=tmp_path)
    assert planned.returncode == 0, planned.stderr
    assert "recalibration_findings" in planned.stdout + planned.stderr
