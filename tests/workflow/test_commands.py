"""Every command of every page is executed by something, or says why it is only planned."""

import re
import shlex
import shutil
import subprocess
import sys

import pytest

from tests.conftest import ROOT, copy_project

PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md"))]
BLOCK = re.compile(r"^ *```(\w*)\n(.*?)^ *```", re.MULTILINE | re.DOTALL)
CONTINUED = re.compile(r"\\\n *")  # on the next line
MODULE = re.compile(r"`(python -m [^`]+)`")  # in the text
PROGRAM = re.compile(r"^ *(\S*python|pip|make|snakemake|recalib|git) ", re.MULTILINE)
LONG = {"quick", "faults", "reproduce", "mutants"}
LONG |= {"tune", "power", "reference", "universes", "horizons"}
TIME = re.compile(r"minutes|hour|time left")
SETTING = ". .venv/bin/activate", "cd examples"  # for the commands after it
LABORATORY = "tests/laboratory/test_command_line.py"  # with a table and a URDF of its own
PICTURES = "tests/vision/test_from_pictures.py"  # that are rendered
CAMERAS = "tests/vision/test_several_cameras.py"
EXAMPLE = "tests/test_library.py::test_an_example_ends_with_small_errors"
STATION = "tests/station/test_program.py::test_the_example_in"
EXECUTED = {  # by a test, or by the check of a change
    "make": ".ci/run",
    "make quick": ".ci/run",
    "make test": ".ci/run",
    "cat results/check.txt": ".ci/run",
    "cp workflow/studies/bent.yaml my_arm.yaml": ".ci/run",
    "make study STUDY=my_arm": ".ci/run",
    "pip install .": "tests/test_library.py::test_the_wheel_works_where_nothing_of_the_studies_is",
    "../.venv/bin/python damage_and_train.py": EXAMPLE,
    ".venv/bin/python examples/own_learner.py": EXAMPLE,
    "recalib calibrate ARM.urdf measurements.csv --tool tool0": (
        f"{LABORATORY}::test_a_calibration_is_a_folder_of_files"
    ),
    "recalib correct calibration/ desired.csv": (
        f"{LABORATORY}::test_commands_take_the_calibrated_arm_to_what_is_desired"
    ),
    "recalib next calibration/": (
        f"{LABORATORY}::test_the_next_postures_are_within_limits_and_teach"
    ),
    "recalib calibrate --poses poses.csv --pictures pictures/ --camera hand": (
        "tests/vision/test_hand_eye.py::test_pictures"
    ),
    "recalib next calibration/ --poses": "tests/vision/test_hand_eye.py::test_pictures",
    "recalib board": f"{PICTURES}::session",
    "recalib observe pictures/ joints.csv": f"{PICTURES}::session",
    "recalib calibrate ARM.urdf observed/ --tool tool0": (
        f"{PICTURES}::test_pictures_lead_to_an_arm_that_is_right_to_half_a_millimetre"
    ),
    "recalib observe left/ left.csv --name left --out observed_left": (
        f"{PICTURES}::test_a_camera_has_its_name_and_a_board_that_of_its_file"
    ),
    "recalib observe right/ right.csv --name right --out observed_right": (
        f"{PICTURES}::test_a_camera_has_its_name_and_a_board_that_of_its_file"
    ),
    "recalib calibrate ARM.urdf observed_left/ observed_right/ --tool tool0": (
        f"{CAMERAS}::test_each_camera_is_written_by_its_name"
    ),
    "recalib live examples/station.py:BentUR10 ur10_robot.urdf --tool tool0 --yes": (
        f"{STATION}_python_is_a_station"
    ),
    'recalib live "node examples/station.js" ur10_robot.urdf --tool tool0 --yes': (
        f"{STATION}_another_language_is_a_station"
    ),
}
PANDA = (  # one after the other, on an arm in MuJoCo
    "python examples/rehearsal/panda.py",
    "recalib observe pictures/ joints.csv --out lens",
    "recalib live examples/rehearsal/panda.py:BentPanda panda.urdf --tool panda_link8"
    ' --board board/board.toml --lens lens/lens.yaml --span "20 deg" --error "0.1 mm" --yes',
    "recalib correct calibration calibration_observed/measurements.csv --frame instrument"
    " --out commands.csv",
)
EXECUTED |= dict.fromkeys(PANDA, "tests/station/test_panda.py::rehearsed")
PLANNED = {  # Snakemake or make says what would run, and the reason why it does not
    "make setup": "whoever runs this has set it up",
    "make cluster": "it installs from a lock, as make tools does",
    "make view": "opens a window",
    "make view STUDY=my_arm": "opens a window",
    "make web": "serves until it is interrupted",
    "make view SCENARIO=translation": "opens a window",
    "make pictures SCENARIO=translation": "needs a Vulkan driver, and minutes where it is software",
    "make view STUDY=ur3": "opens a window",
    "make web STUDY=my_arm": "serves until it is interrupted",
    "make web STUDY=quick": "serves until it is interrupted",
    "make study STUDY=ur3": "a minute, and as make quick",
    "make study STUDY=coarse": "three minutes",
    "snakemake --cores 2 figures/figure1.svg": "most of the replication, which make has made",
    "snakemake --cores 2 --forcerun claims -- results/claims.json": "the same",
}
BY_HAND = {
    "pip install '.[laboratory,vision]'": "part of what make vision installs",
    "pip install '.[laboratory,vision,live]'": "part of what make vision and make live install",
    "pip install '.[laboratory]'": "part of what make setup installs",
    "snakemake --cores 1 results/real/fit.csv": "fetches a table from the network",
    "recalib calibrate ur5_robot.urdf results/real/fit.csv --tool tool0"
    " --description workflow/real/ur5.toml": "with the table that was fetched",
    "git status --short": "of the reader's own checkout",
    "snakemake --profile profiles/slurm universes": "an hour on a cluster; see make slurm",
    "python -m recalib.study.configuration.schema": "a test compares what it has written",
    "python -m recalib.study.evidence.pages.deviations": "a test compares what it prints",
    "python -m tests.station.bars": "whole tables of calibrations",
    "python -m tests.station.bars ur5": "part of these tables",
    "python -m tests.station.film": "a film that was looked at",
    "python -m tests.station.paper_live": "15 minutes",
    "python -m tests.station.recording": "5 minutes; a test makes its learners",
    "python -m tests.vision.bars": "whole tables of calibrations; tests use its parts",
    "python -m tests.vision.hand_eye_bars": "20 minutes, and OpenCV 4; tests use its cells",
    "python -m tests.vision.several": "whole tables of calibrations",
}


def commands() -> list[str]:
    """All commands of all pages, without their comments; in the text, those that run a module."""
    texts = [page.read_text(encoding="utf-8") for page in PAGES]
    lines = {
        line.partition("#")[0].strip()
        for text in texts
        for language, block in BLOCK.findall(text)
        if language == "sh"
        for line in CONTINUED.sub("", block).splitlines()
    }
    modules = {command for text in texts for command in MODULE.findall(text)}
    return sorted({*filter(None, lines), *modules} - {*SETTING})


@pytest.mark.parametrize("page", PAGES, ids=[page.name for page in PAGES])
def test_a_block_of_commands_is_one_of_sh(page):
    blocks = BLOCK.findall(page.read_text(encoding="utf-8"))
    assert not [block for language, block in blocks if language != "sh" and PROGRAM.search(block)]


def test_what_is_said_of_commands_is_said_of_those_on_pages():
    assert sorted(EXECUTED | PLANNED | BY_HAND) == commands()


@pytest.mark.parametrize("command", EXECUTED)
def test_what_executes_a_command_is_there(command):
    path, _, name = EXECUTED[command].partition("::")
    text = (ROOT / path).read_text(encoding="utf-8")
    assert re.search(rf"^def {name}\(" if name else rf"^{re.escape(command)}$", text, re.MULTILINE)


@pytest.fixture(scope="module")
def checkout(tmp_path_factory):
    """A copy of the project: to plan leaves notes."""
    folder = copy_project(tmp_path_factory.mktemp("checkout"))
    for path in ("Makefile", "requirements-extras.lock"):
        shutil.copy(ROOT / path, folder)
    shutil.copy(ROOT / "workflow" / "studies" / "bent.yaml", folder / "my_arm.yaml")
    return folder


@pytest.mark.parametrize(
    "command",
    [pytest.param(it, marks=[pytest.mark.slow] * it.startswith("snakemake")) for it in PLANNED],
)
def test_a_command_can_be_planned(command, checkout):
    program, *arguments = shlex.split(command)
    plan = {
        "make": ["make", "--dry-run", "--old-file=.venv/installed"],
        "snakemake": [sys.executable, "-m", "snakemake", "--dry-run", "--quiet"],
    }[program]
    planned = subprocess.run(
        [*plan, *arguments], cwd=checkout, text=True, capture_output=True, check=False
    )
    assert planned.returncode == 0, planned.stderr


def test_make_help_names_every_target_and_pages_name_no_other():
    text = (ROOT / "Makefile").read_text(encoding="utf-8")
    targets = set(re.search(r"^\.PHONY: (.*)", text, re.MULTILINE)[1].split())
    told = subprocess.run(  # make, run by make, would name the folder that it enters
        ["make", "--no-print-directory", "help"],
        cwd=ROOT,
        text=True,
        capture_output=True,
        check=True,
    )
    helped = {line.split()[0] for line in told.stdout.splitlines() if len(line.split()) > 2}
    assert helped == targets
    timed = {line.split()[0] for line in told.stdout.splitlines() if TIME.search(line)}
    assert timed >= LONG, "whoever waits knows for how long"
    named = {
        target
        for page in PAGES
        for target in re.findall(r"`make ([a-z-]+)", page.read_text(encoding="utf-8"))
    }
    assert named <= targets
