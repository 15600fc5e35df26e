"""What is checked elsewhere is what is checked here, and a release has one version."""

import re
import tomllib

import yaml

import recalib
from tests.conftest import ROOT

# A command at the beginning of a line, without what depends on the machine.
COMMAND = re.compile(
    r"^(?:sudo )?((?:make|cp|git|cat|command|\.venv/bin/python)\b(?: (?!PYTHON=|\|\||#)\S+)*)",
    re.MULTILINE,
)
WORKFLOWS = ROOT / ".github" / "workflows"


def commands(text: str) -> set[str]:
    return {*COMMAND.findall(text)}


def checked() -> list[dict]:
    """What the workflow for GitHub runs: a row for each job."""
    workflow = yaml.safe_load((WORKFLOWS / "ci.yml").read_text(encoding="utf-8"))
    return workflow["jobs"]["check"]["strategy"]["matrix"]["include"]


def test_github_runs_what_the_check_of_a_change_runs():
    elsewhere = set().union(*(commands(row["run"]) for row in checked()))
    here = commands((ROOT / ".ci" / "run").read_text(encoding="utf-8"))
    assert "make" in here and len(here) > 10
    assert elsewhere == here


def test_every_python_that_is_promised_runs_the_tests():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    python = "Programming Language :: Python :: "
    names = (classifier for classifier in project["classifiers"] if classifier.startswith(python))
    promised = [classifier.removeprefix(python) for classifier in names]
    on_linux = [row for row in checked() if row["run"] == "make test" and "os" not in row]
    assert [row.get("python", "3.11") for row in on_linux] == promised
    assert project["requires-python"] == f">={promised[0]}"


def test_files_that_name_the_version_name_the_same():
    named = {
        name: yaml.safe_load((ROOT / name).read_text(encoding="utf-8"))["version"]
        for name in ("CITATION.cff", ".zenodo.json")
    }
    changelog = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    named["CHANGELOG.md"] = re.search(r"^## \[(.+?)\]", changelog, re.MULTILINE)[1]
    published = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8").partition("## Publish")[2]
    (named["CONTRIBUTING.md"],) = {*re.findall(r"\d+\.\d+\.\d+", published)}
    assert named == dict.fromkeys(named, recalib.__version__)


def test_actions_are_pinned_by_hash_and_what_may_write_runs_nothing_of_ours():
    for path in WORKFLOWS.glob("*.yml"):
        text = path.read_text(encoding="utf-8")
        for action in re.findall(r"uses: (\S+)", text):
            assert action.startswith("./") or re.search(r"@[0-9a-f]{40}$", action), action
        workflow = yaml.safe_load(text)
        assert workflow["permissions"] == {"contents": "read"}
        for job in workflow["jobs"].values():
            steps = job.get("steps", [])
            checkouts = [step for step in steps if "checkout" in step.get("uses", "")]
            assert all(step["with"]["persist-credentials"] is False for step in checkouts)
            if "permissions" in job:
                assert not checkouts
                assert all(step.get("run", "gh ").startswith("gh ") for step in steps)


def test_every_extra_is_locked_with_hashes():
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    locks = [path.read_text(encoding="utf-8") for path in ROOT.glob("requirements*.lock")]
    names = {
        re.match(r"[\w.-]+", requirement)[0].replace(".", "-")
        for part in extras["optional-dependencies"].values()
        for requirement in part
    }
    for name in names:
        pinned = rf"^{name}==\S+.* \\\n    --hash=sha256"
        assert any(re.search(pinned, lock, re.MULTILINE) for lock in locks), name
