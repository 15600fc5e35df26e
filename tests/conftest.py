"""What the tests share: the configuration of the project and its default robot."""

import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

os.environ["OMP_NUM_THREADS"] = (
    "1"  # before NumPy is there: small matrices are slower on many threads than on one
)

import numpy as np
import pytest
import yaml

from recalib.damaged.damage import DamagedArm, EncoderShift, LinkShortening, apply
from recalib.nominal.controller import Controller
from recalib.nominal.robots import Robot
from recalib.study.scenarios import load_controller, robot_of_entry

ROOT = Path(__file__).parents[1]
SNAKEMAKE = [sys.executable, "-m", "snakemake", "--cores", "2", "--configfile", "tests/tiny.yaml"]
PARTS = ["Snakefile", "config.yaml", "workflow", "recalib", "profiles", "tests"]


@pytest.fixture(scope="session")
def config() -> dict:
    return yaml.safe_load((ROOT / "config.yaml").read_text())


@pytest.fixture(scope="session")
def robot(config) -> Robot:
    return robot_of_entry("ur10", config["robots"]["ur10"])


@pytest.fixture(scope="session")
def controller(config) -> Controller:
    return load_controller("ur10", config)


@pytest.fixture(scope="session")
def damaged(robot) -> DamagedArm:
    """A damage as serious as the paper's."""
    shift = (
        EncoderShift("elbow_joint", np.radians(4)),
        EncoderShift("wrist_3_joint", np.radians(-3)),
    )
    return apply(robot, [LinkShortening("forearm_link", 0.04), *shift])


def snakemake(project, *arguments) -> subprocess.CompletedProcess:
    return subprocess.run(
        [*SNAKEMAKE, *arguments],
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
        SNAKEMAKE,
        cwd=folder,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    whole = "results/runs/*/[!.]*.parquet"  # a dot begins the name of a file in the making
    deadline = time.monotonic() + 120
    while process.poll() is None and not list(folder.glob(whole)) and time.monotonic() < deadline:
        time.sleep(0.05)
    assert process.poll() is None, "the run ended before it could be interrupted"
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    gathered = [path.relative_to(folder / "results" / "runs") for path in folder.glob(whole)]
    chunks = [
        path
        for run in gathered
        for path in folder.glob(f"results/chunks/{run.parent}/{run.stem}.*.parquet")
    ]
    done = {path: path.stat().st_mtime_ns for path in chunks}
    finished = snakemake(folder)
    assert finished.returncode == 0, finished.stdout
    assert done and all(path.stat().st_mtime_ns == then for path, then in done.items()), (
        "what was done is kept"
    )
    return folder
