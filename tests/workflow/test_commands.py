"""Every command of every page can be given: it is planned, or its options are read."""

import re
import shlex
import shutil
import sys
from pathlib import Path

import pytest

from recalib.laboratory.options import parse
from tests.conftest import ROOT, copy_project, run

TEMPLATES = ROOT / "workflow" / "templates"
WRITTEN = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md"))]
PAGES = [  # those with results as templates
    template if (template := TEMPLATES / f"{page.name}.j2").exists() else page for page in WRITTEN
]
BLOCK = re.compile(r"^ *```(\w*)\n(.*?)^ *```", re.MULTILINE | re.DOTALL)
CONTINUED = re.compile(r"\\\n *")  # on the next line
MODULE = re.compile(r"`(python -m [^`]+)`")  # in the text
LONG = {"quick", "faults", "reproduce", "mutants", "tune", "campaign"}
TIME = re.compile(r"minutes|hour|time left")
SETTING = ". .venv/bin/activate", "cd examples"  # for the commands after it


def commands() -> list[str]:
    """All commands of all pages, without their comments; in the text, those that run a module."""
    texts = [page.read_text(encoding="utf-8") for page in PAGES]
    lines = {
        line.partition("#")[0].strip()
        for text in texts
        for language, block in BLOCK.findall(text)
        if language == "sh"
        for line in CONTINUED.sub("", block).splitlines()
        if not line.startswith("{%")  # of a template
    }
    modules = {command for text in texts for command in MODULE.findall(text)}
    return sorted({*filter(None, lines), *modules} - {*SETTING})


@pytest.fixture(scope="module")
def checkout(tmp_path_factory):
    """A copy of the project: to plan leaves notes."""
    folder = copy_project(tmp_path_factory.mktemp("checkout"))
    for path in ("Makefile", "requirements-extras.lock"):
        shutil.copy(ROOT / path, folder)
    shutil.copy(ROOT / "workflow" / "studies" / "bent.yaml", folder / "my_arm.yaml")
    return folder


PLANS = {
    "make": ["make", "--dry-run", "--old-file=.venv/installed", "--old-file=.venv/tools"],
    "snakemake": [sys.executable, "-m", "snakemake", "--dry-run", "--quiet"],
}
LEFT = "pip ", "cp ", "cat ", "git ", "snakemake --profile"  # not ours; on a cluster alone


@pytest.mark.parametrize(
    "command",
    [
        pytest.param(command, marks=[pytest.mark.slow] * command.startswith("snakemake"))
        for command in commands()
        if not command.startswith(LEFT)
    ],
)
def test_a_command_can_be_given(command, request):
    program, *arguments = shlex.split(command)
    if program == "recalib":
        parse(arguments)  # which ends with a sentence if it knows one of them not
    elif program.endswith("python"):
        name = arguments[1] if arguments[0] == "-m" else arguments[0].removeprefix("examples/")
        path = Path(*name.split(".")).with_suffix(".py") if "-m" in arguments else Path(name)
        folder = ROOT if "-m" in arguments else ROOT / "examples"
        assert (folder / path).exists() or (folder / path.with_suffix("") / "__main__.py").exists()
    else:
        planned = run(*PLANS[program], *arguments, cwd=request.getfixturevalue("checkout"))
        assert planned.returncode == 0, planned.stderr


def test_make_help_names_every_target_and_pages_name_no_other():
    text = (ROOT / "Makefile").read_text(encoding="utf-8")
    targets = set(re.search(r"^\.PHONY: (.*)", text, re.MULTILINE)[1].split())
    # make, run by make, would name the folder that it enters
    printed = run("make", "--no-print-directory", "help", check=True)
    helped = {line.split()[0] for line in printed.stdout.splitlines() if len(line.split()) > 2}
    assert helped == targets
    timed = {line.split()[0] for line in printed.stdout.splitlines() if TIME.search(line)}
    assert timed >= LONG, "whoever waits knows for how long"
    named = {
        target
        for page in PAGES
        for target in re.findall(r"`make ([a-z-]+)", page.read_text(encoding="utf-8"))
    }
    assert named <= targets
