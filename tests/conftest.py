"""What the tests share: the shipped study and its robot, and copies of the project."""

import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

# before NumPy is there: small matrices are slower on many threads than on one
os.environ["OMP_NUM_THREADS"] = "1"

import numpy as np
import pytest
from hypothesis import settings

from recalib.damaged.damage import DamagedArm, EncoderShift, LinkShortening, apply
from recalib.nominal.controller import Controller
from recalib.nominal.robots import Robot
from recalib.study.configuration.reading import read_study
from recalib.study.configuration.study import Study
from recalib.study.jobs import Nominal
from recalib.study.plan import Plan
from recalib.study.plants import nominal_controller
from tests.made_up import NOISE, MadeUp

settings.register_profile("untimed", deadline=None)  # what is compiled takes seconds, once
settings.load_profile("untimed")

ROOT = Path(__file__).parents[1]
SNAKEMAKE = [sys.executable, "-m", "snakemake", "--cores", "2"]
SMALL = ["--configfile", "tests/tiny.yaml"]
TINY = "results/studies/tiny"  # where they lie, by the name in tests/tiny.yaml
PARTS = [".gitignore", "Snakefile", "config.yaml", "README.md", "workflow", "recalib", "profiles"]
PARTS += ["tests", "docs", "figures"]


@pytest.fixture(scope="session")
def study() -> Study:
    return read_study(ROOT / "config.yaml")


@pytest.fixture(scope="session")
def plan(study) -> Plan:
    return Plan(study)


@pytest.fixture(scope="session")
def few(study) -> Study:
    """The study with fewer searches, seeds and benchmarks: it shows as much, in less time."""
    less = {
        "search": {"searches": 4, "searches_long": 3},
        "training": {"seeds": 2},
        "benchmark": {
            "scenarios": ("links_encoders", "links_encoders_gears_sag", "gears", "noise"),
            "learners": ("affine", "geometric", "hybrid", "improved"),
        },
    }
    parts = {part: getattr(study, part).model_copy(update=its) for part, its in less.items()}
    return study.model_copy(update={"name": "few", **parts})


@pytest.fixture(scope="session")
def made_up(few, tmp_path_factory) -> MadeUp:
    """Results that support every claim."""
    its = MadeUp(tmp_path_factory.mktemp("made_up"), few)
    its.conclude()
    return its


@pytest.fixture(scope="session")
def disturbed(few, tmp_path_factory) -> MadeUp:
    """The same, as another machine would round them."""
    its = MadeUp(tmp_path_factory.mktemp("disturbed"), few, noise=NOISE)
    its.conclude()
    return its


def changed(nominal: Nominal, **entry) -> Nominal:
    """The robot with keys of its entry changed, in SI units."""
    return nominal.model_copy(update={"robot": nominal.robot.model_copy(update=entry)})


@pytest.fixture(scope="session")
def controller(plan) -> Controller:
    return nominal_controller(plan.nominal("ur10"))


@pytest.fixture(scope="session")
def robot(controller) -> Robot:
    return controller.robot


@pytest.fixture(scope="session")
def damaged(robot) -> DamagedArm:
    """A damage as serious as the paper's."""
    shift = (
        EncoderShift("elbow_joint", np.radians(4)),
        EncoderShift("wrist_3_joint", np.radians(-3)),
    )
    return apply(robot, [LinkShortening("forearm_link", 0.04), *shift])


def snakemake(project, *arguments, small=True) -> subprocess.CompletedProcess:
    """Run the workflow in a copy of the project: on the small study, or as it is shipped."""
    return subprocess.run(
        [*SNAKEMAKE, *(SMALL if small else []), *arguments],
        cwd=project,
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        check=False,
    )


def copy_project(folder: Path) -> Path:
    for part in PARTS:
        copy = shutil.copytree if (ROOT / part).is_dir() else shutil.copy
        copy(ROOT / part, folder / part)
    return folder


@pytest.fixture(scope="session")
def project(tmp_path_factory) -> Path:
    """A copy of the project whose run was killed in the middle and started again."""
    folder = copy_project(tmp_path_factory.mktemp("project"))
    process = subprocess.Popen(
        [*SNAKEMAKE, *SMALL],
        cwd=folder,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    whole = f"{TINY}/runs/*/[!.]*.parquet"  # a dot begins the name of a file in the making
    deadline = time.monotonic() + 600
    while process.poll() is None and not list(folder.glob(whole)) and time.monotonic() < deadline:
        time.sleep(0.05)
    assert process.poll() is None, "the run ended before it could be interrupted"
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    gathered = [path.relative_to(folder / TINY / "runs") for path in folder.glob(whole)]
    chunks = [
        path
        for run in gathered
        for path in folder.glob(f"{TINY}/chunks/runs/{run.parent}/{run.stem}.*.parquet")
    ]
    done = {path: path.stat().st_mtime_ns for path in chunks}
    finished = snakemake(folder)
    assert finished.returncode == 0, finished.stdout
    assert done and all(path.stat().st_mtime_ns == then for path, then in done.items()), (
        "what was done is kept"
    )
    return folder
