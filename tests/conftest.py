"""What the tests share: the shipped study and its robot, and copies of the project."""

import fcntl
import gc
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import NamedTuple
from unittest import mock

# before NumPy is there: small matrices are slower on many threads than on one
os.environ["OMP_NUM_THREADS"] = "1"

import numpy as np
import pytest
from hypothesis import settings
from numba.core.dispatcher import Dispatcher
from pydantic import BaseModel

from recalib import (
    Arm,
    Controller,
    DamagedArm,
    EncoderShift,
    LinkShortening,
    RadialLearner,
    Robot,
    Rules,
    Schedule,
    apply,
    load_arm,
)
from recalib.learners import class_of
from recalib.nominal import arm_of
from replication.config import Study, read_study
from replication.scenarios import Nominal, Resolved, nominal_controller, resolve
from replication.scenarios.plants import nominal_of
from replication.training import make_peer, peers
from tests import arms

settings.register_profile("untimed", deadline=None)  # what is compiled takes seconds, once
settings.load_profile("untimed")


def compile_once(loop: Dispatcher, signature, compiled=Dispatcher.compile):
    """Of processes that need a loop at once, one compiles it, and the others read its cache."""
    if (folder := loop._cache.cache_path) is None:
        return compiled(loop, signature)
    Path(folder).mkdir(parents=True, exist_ok=True)
    with open(Path(folder, f"{loop.__name__}.lock"), "w") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        return compiled(loop, signature)


Dispatcher.compile = compile_once
ROOT = Path(__file__).parents[1]
PARTS = [".gitignore", "Snakefile", "config.yaml", "pyproject.toml", "CITATION.cff", "README.md"]
PARTS += ["workflow", "recalib", "profiles", "replication", "tests", "docs", "figures"]
SHARED = "figures", "rules"  # fixtures that one process makes for all


def run(*command, cwd: Path = ROOT, **options) -> subprocess.CompletedProcess:
    """How a command ends, and what it prints."""
    return subprocess.run(command, cwd=cwd, text=True, capture_output=True, **options)


def loaded_with(statement: str, heavy: set[str]) -> set[str]:
    """Which heavy packages a statement imports."""
    text = f"import sys; {statement}; print(*({heavy} & sys.modules.keys()))"
    return {*run(sys.executable, "-c", text, check=True).stdout.split()}


def pytest_collection() -> None:
    """Thousands of tests are collected, and none is garbage: looking for it took as long again."""
    gc.disable()


def pytest_collection_finish() -> None:
    gc.freeze()
    gc.set_threshold(100_000, 50, 100)  # few objects of tests are in cycles
    gc.enable()


@contextmanager
def few_folds() -> Iterator[None]:
    """Few folds and few sets of rows to start from: what they tell is tested where they are."""
    with (
        mock.patch("recalib.identification.initial_estimate.SETS", 8),
        mock.patch("recalib.identification.initial_estimate.REFINED", 2),
        mock.patch("recalib.identification.held_out.FOLDS", 3),
        mock.patch("recalib.identification.consensus.SETS", 20),
    ):
        yield


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """A process takes all tests of a file, or of what is marked as a group: fixtures are shared.

    So are the fixtures of a session that take long.
    """
    for item in items:
        if not item.get_closest_marker("xdist_group"):
            shared = next((name for name in SHARED if name in item.fixturenames), item.location[0])
            item.add_marker(pytest.mark.xdist_group(name=shared))


@pytest.fixture(scope="session")
def study() -> Study:
    return read_study(ROOT / "config.yaml")


class Plan(NamedTuple):
    """Parts of a study, as jobs get them."""

    study: Study

    def nominal(self, robot: str) -> Nominal:
        return nominal_of(self.study, robot)

    def resolved(self, scenario: str) -> Resolved:
        """A scenario on the study's robot."""
        return resolve(self.study, self.study.robot, [scenario])[0][0]


@pytest.fixture(scope="session")
def plan(study) -> Plan:
    return Plan(study)


def changed(model: BaseModel, **keys):
    """A model, such as a study, with keys of it changed, and by mappings those of its parts."""

    def part(own, value):
        inner = isinstance(own, BaseModel) and isinstance(value, dict)
        return changed(own, **value) if inner else value

    update = {name: part(getattr(model, name), value) for name, value in keys.items()}
    return model.model_copy(update=update)


@pytest.fixture(scope="session")
def controller(plan) -> Controller:
    return nominal_controller(plan.nominal("ur10"))


@pytest.fixture(scope="session")
def robot(controller) -> Robot:
    return controller.robot


@pytest.fixture(scope="session")
def makers(robot) -> dict[str, Callable]:
    """Of each kind a learner that has learned nothing, from its `runs`."""
    rules = Rules(True, True, True, True, subnet=(3, 2, 1))
    widths = {"position": (0.6, 1.5), "orientation": (1.0, 1.0)}
    schedule = Schedule(4.0, widths, 0.8, 0.4)
    of_paper = partial(class_of("hierarchical"), rules=rules, schedule=schedule)
    peer_of = {peer.kind: name for name, peer in peers().items() if peer.kind}
    of_today = {kind: partial(make_peer, name, robot=robot) for kind, name in peer_of.items()}
    radial = partial(RadialLearner, rules, schedule, 0.4)
    return {"hierarchical": of_paper, "radial": radial} | of_today


@pytest.fixture(scope="session")
def load() -> Callable[..., Arm]:
    """Loads an arm from the text of a URDF."""
    return lambda text: arm_of(text.encode(), Path("small.urdf"))


@pytest.fixture(scope="session")
def damaged(robot) -> DamagedArm:
    """A damage as serious as the paper's."""
    shifts = {"elbow_joint": np.radians(4), "wrist_3_joint": np.radians(-3)}
    shift = [EncoderShift(joint, angle) for joint, angle in shifts.items()]
    return apply(robot, [LinkShortening("forearm_link", 0.04), *shift])


@pytest.fixture(scope="session")
def ur10() -> Arm:
    return load_arm("ur10_robot.urdf", "tool0")


@pytest.fixture(scope="session")
def panda() -> Arm:
    return load_arm("panda.urdf", "panda_link8")


@pytest.fixture(scope="session")
def redundant() -> Controller:
    """Of seven joints."""
    return Controller(arms.panda())


def copy_project(folder: Path) -> Path:
    """Copy what the workflow and the tests need of the project into a folder."""
    for part in PARTS:
        copy = shutil.copytree if (ROOT / part).is_dir() else shutil.copy
        copy(ROOT / part, folder / part)
    return folder
