"""The library by itself: its public names, its examples, and its wheel where nothing else is."""

import ast
import inspect
import os
import re
import runpy
import shutil
import subprocess
import sys
import tarfile
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import recalib
from recalib.nominal import find_urdf
from recalib.station import cells_of
from tests.conftest import ROOT, run
from tests.laboratory.conftest import in_degrees, in_millimetres, write

# the robot and the station of the examples; tests/test_notebook.py; tests/vision has one
ALONE = "ur10", "station", "notebook", "poses"
EXAMPLES = sorted(path.stem for path in (ROOT / "examples").glob("*.py") if path.stem not in ALONE)
FOR_STUDIES = "matplotlib", "pandas", "pydantic", "rerun", "snakemake"


@pytest.mark.parametrize("name", recalib.__all__)
def test_a_public_name_has_a_home_and_says_what_it_is(name):
    if name == "calibrate_pictures":
        pytest.importorskip("cv2", reason="needs OpenCV, of the extra vision")
    value = getattr(recalib, name)
    assert name in dir(recalib)
    if name.isupper():
        return
    assert value.__module__.startswith("recalib.")
    assert len(inspect.getdoc(value)) > 30


def test_an_unknown_name_is_no_attribute():
    with pytest.raises(ImportError, match="cannot import name 'trian'"):
        from recalib import trian  # noqa: F401


def test_the_three_lines_for_an_arm_of_ones_own_reduce_its_errors(monkeypatch, tmp_path, capsys):
    """Those of docs/library.md, with a UR10 whose encoders are off by half degrees as one's own."""
    monkeypatch.chdir(tmp_path)
    shutil.copy(find_urdf("ur10_robot.urdf"), "my_arm.urdf")
    blocks = re.findall(
        r"^```python\n(.*?)^```", (ROOT / "docs/library.md").read_text(), re.MULTILINE | re.DOTALL
    )
    identify, learn = (block for block in blocks if "my_arm.urdf" in block)
    assert max(block.count("\n") for block in (identify, learn)) == 3
    arm, rng = recalib.load_arm("my_arm.urdf", "tool0"), np.random.default_rng(47)
    offsets = np.radians([0.0, 0.5, -0.5, 0.5, -0.5, 0.0])
    joints = rng.uniform(-1, 1, (30, 6)) + np.array([0, -1, 2, -2, -1.6, 0])
    positions = arm.forward(joints + offsets)[:, :3, 3]
    used = {*re.findall(r"\w+", identify + learn)} & {*recalib.__all__}
    names = {name: getattr(recalib, name) for name in used}
    exec(identify, names | {"joints": joints, "positions": positions})
    assert "mm" in capsys.readouterr().out
    home = dict(zip(arm.joints, np.array([0, -1.4, 2.1, -2.9, -1.57, 0]), strict=True))
    robot = recalib.load_robot("my_arm.urdf", "tool0", home, [0.3] * 3, [0.6] * 3)
    controller = recalib.Controller(robot)

    def move(pose):
        return arm.forward(controller.inverse(pose[None]) + offsets)[0]

    names |= {"home": home, "move": move, "rng": rng}
    exec(learn, names)
    first, last = names["history"].position_error
    assert first > 5e-3 and last < 1e-6  # m: the learner's model holds the errors of this arm


@pytest.mark.parametrize(
    "path", sorted((ROOT / "examples").glob("*.py")), ids=lambda path: path.stem
)
def test_an_example_needs_the_public_names_alone(path):
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            modules = {alias.name for alias in node.names}
        else:
            modules = {node.module} if isinstance(node, ast.ImportFrom) else set()
        assert not {module for module in modules if module.startswith("recalib.")}
        if modules == {"recalib"} and isinstance(node, ast.ImportFrom):
            assert {alias.name for alias in node.names} <= {*recalib.__all__}
        if isinstance(node, ast.Attribute) and ast.unparse(node.value) == "recalib":
            assert node.attr in recalib.__all__


def wrong_calls() -> dict[str, Callable[[], object]]:
    """Calls with an argument of another kind, shape or size, by their name."""
    urdf = find_urdf("ur10_robot.urdf")
    home = {"shoulder_lift_joint": -1.4, "elbow_joint": 2.1, "wrist_1_joint": -2.9}
    home |= {"shoulder_pan_joint": 0.0, "wrist_2_joint": -1.57, "wrist_3_joint": 0.0}
    robot = recalib.load_robot(urdf, "tool0", home, [0.3] * 3, [0.6] * 3)
    controller, pair, rules = recalib.Controller(robot), (1.0, 1.0), recalib.IMPROVED
    good = {"initial_width": 2.0, "initial_rate": 0.9, "final_rate": 0.5}
    good["final_widths"] = {"position": pair, "orientation": pair}
    schedule = recalib.Schedule(**good)
    learner = recalib.HierarchicalLearner(rules, schedule)
    plant = recalib.Plant(controller, recalib.apply(robot, []))
    poses, joints, chain = np.zeros((1, 2, 6)), np.zeros((3, 6)), recalib.Chain.of(robot.arm)
    own = recalib.ExternalRobot(robot.workspace, lambda pose: pose)
    arrays = recalib.Observations(joints, joints[:, :3])
    moved = recalib.Plant(controller, recalib.apply(robot, []))
    moved.execute(np.zeros((2, 1, 6)))
    postures = np.random.default_rng(0).uniform(-1, 1, (12, 6)) + robot.home
    measured = recalib.Observations(postures, robot.arm.forward(postures))
    found = recalib.GeometricLearner.identify(robot.arm, measured)
    others = {"a string": "2", "nothing": None, "words": ["a", "b"], "nan": np.nan, "zero": 0}
    calls = {
        f"a schedule whose {key} is {name}": partial(recalib.Schedule, **good | {key: value})
        for key in good
        for name, value in others.items()
    }
    for name, other in {"nothing": None, "an arm": robot.arm, "a number": 3}.items():
        calls |= {
            f"a controller of {name}": partial(recalib.Controller, other),
            f"a plant behind {name}": partial(recalib.Plant, other, robot.arm),
            f"{name} for rules": partial(recalib.HierarchicalLearner, other, schedule),
            f"{name} for rules of units": partial(recalib.RadialLearner, other, schedule),
            f"{name} for a schedule": partial(recalib.HierarchicalLearner, rules, other),
            f"a learner behind {name}": partial(recalib.HybridLearner, other),
            f"{name} observed": partial(recalib.HybridLearner.identify, robot.arm, other),
            f"{name} trained": partial(recalib.train, plant, other, poses, poses, [1]),
            f"{name} that moves": partial(recalib.ExternalRobot, robot.workspace, other),
            f"{name} as damage": partial(recalib.apply, robot, [other]),
            f"{name} saved": partial(recalib.save, Path("never.npz"), learner, other),
            f"{name} loaded": partial(recalib.load, Path("never.npz"), other),
            f"a workspace about {name}": partial(recalib.Workspace, other, np.ones(6)),
            f"a workspace as large as {name}": partial(recalib.Workspace, np.eye(4), other),
            f"noise of {name}": partial(recalib.Noise, other),
            f"rows of {name}": partial(recalib.arm_of_table, other),
            f"gains of {name}": partial(recalib.information_gains, other, joints),
            f"frames from {name}": partial(recalib.initial_frames, robot.arm, other),
        }
    kinds = {"nothing": None, "a robot": robot, "a number": 3, "words": ["a", "b"], "text": "arm"}
    ranges = [0.3] * 3, [0.6] * 3
    for name, other in kinds.items():
        calls |= {
            f"a chain of {name}": partial(recalib.Chain.of, other),
            f"a chain of {name} at its side": partial(recalib.Chain.side_by_side, [other]),
            f"angles of {name}": partial(chain.forward, other),
            f"poses of {name}": partial(chain.solve, other, joints),
            f"a start of {name}": partial(chain.solve, np.ones((3, 4, 4)), other),
            f"commands of {name}": partial(plant.execute, other),
            f"moves of {name}": partial(plant.achieve, other),
            f"moves of one's own of {name}": partial(own.execute, other),
            f"targets of {name}": partial(controller.targets, other),
            f"coordinates of {name}": partial(robot.workspace.to_poses, other),
            f"arms of {name}": partial(recalib.Plant, controller, [other]),
            f"generators of {name}": partial(
                recalib.Plant, controller, robot.arm, recalib.Disturbances(), [other]
            ),
            f"a home of {name}": partial(recalib.load_robot, urdf, "tool0", other, *ranges),
            f"a range of {name}": partial(
                recalib.load_robot, urdf, "tool0", home, other, ranges[1]
            ),
            f"shapes of {name}": partial(recalib.load_shapes, other, urdf),
            f"a row named {name}": partial(
                recalib.arm_of_table, [recalib.Row(other), recalib.Row(other)]
            ),
            f"a joint that slides by {name}": partial(
                recalib.arm_of_table, [recalib.Row("a", slides=other)]
            ),
            f"measured at {name}": partial(recalib.train, plant, learner, poses, poses, other),
            f"cells of {name}": partial(cells_of, other),
            f"a box of {name}": partial(
                recalib.LiveSettings, box=np.eye(3) if other is None else other
            ),
            f"a live arm of {name}": partial(
                recalib.calibrate_live, object, other, "never.csv", recalib.LiveSettings()
            ),
            f"live settings of {name}": partial(
                recalib.calibrate_live, object, robot.arm, "never.csv", other
            ),
            f"a station of {name}": partial(
                recalib.calibrate_live, other, robot.arm, "never.csv", recalib.LiveSettings()
            ),
            f"progress to {name}": partial(
                recalib.calibrate, robot.arm, postures, measured.measured, on_progress=other
            ),
            f"a distance of {name}": partial(
                recalib.calibrate,
                *(robot.arm, postures),
                sockets=["a", "b"] * 6,
                distances={("a", "b"): other},
            ),
            f"a program of {name}": partial(
                recalib.ProgramStation, [] if isinstance(other, list) else other
            ),
            f"learned by one that is to command {name}": partial(learner.command, other),
            f"learned from {name}": partial(learner.learn, other, plant.execute, 0.1),
            f"a polynomial of {name}": partial(recalib.PolynomialLearner(1).command, other),
            f"a process of {name}": partial(recalib.GaussianProcessLearner().command, other),
            f"units of {name}": partial(recalib.RadialLearner(rules, schedule).command, other),
            f"a calibration of {name}": partial(
                recalib.GeometricLearner(controller).learn, other, plant.execute, 0.1
            ),
        }
    for key in ("speed", "span", "most", "floor", "error"):
        for name, other in {"text": "fast", "words": ["a"], "nan": np.nan}.items():
            calls[f"a live {key} of {name}"] = partial(recalib.LiveSettings, **{key: other})
    for shape in ((2, 6), (1, 2, 5), (1, 2, 7), (6,), (2, 1, 2, 6)):
        calls[f"commands of shape {shape}"] = partial(plant.execute, np.zeros(shape))
        calls[f"moves of shape {shape}"] = partial(plant.achieve, np.zeros(shape))
    for size in (5, 7):
        calls[f"{size} offsets"] = partial(recalib.Chain.of, robot.arm, np.zeros(size))
    return calls | {
        "no run": partial(recalib.GaussianProcessLearner, runs=0),
        "half a run": partial(recalib.PolynomialLearner, 1, runs=0.5),
        "a robot identified": partial(recalib.HybridLearner.identify, robot, arrays),
        "a shift in words": partial(recalib.EncoderShift, "elbow_joint", "3 deg"),
        "no shift": partial(recalib.EncoderShift, "elbow_joint", None),
        "joints of another arm": partial(recalib.information_gains, found, joints[:, :5]),
        "one posture for many": partial(recalib.information_gains, found, joints[0]),
        "the learner before the plant": partial(recalib.train, learner, plant, poses, poses, [1]),
        "a damage that is no list": partial(recalib.apply, robot, recalib.Noise()),
        "no arms": partial(recalib.Plant, controller, []),
        "no chains": partial(recalib.Chain.side_by_side, []),
        "no generators": partial(recalib.Plant, controller, robot.arm, recalib.Disturbances()),
        "other runs than before": partial(moved.execute, np.zeros((3, 1, 6))),
        "fewer runs than before": partial(moved.execute, np.zeros((1, 1, 6))),
        "fewer runs than arms": partial(
            recalib.Plant(controller, [recalib.apply(robot, [])] * 3).execute,
            np.zeros((2, 1, 6)),
        ),
        "poses for others": partial(recalib.position_error, np.ones((3, 4, 4)), np.ones((2, 4, 4))),
        "limits the wrong way round": partial(
            *(recalib.load_robot, urdf, "tool0", home, *ranges), limits={"elbow_joint": (3, -3)}
        ),
        "limits of one end": partial(
            *(recalib.load_robot, urdf, "tool0", home, *ranges), limits={"elbow_joint": 3}
        ),
        "a tool beyond, in words": partial(
            *(recalib.load_robot, urdf, "tool0", home, *ranges), beyond="10 cm"
        ),
        "a word with a NUL": partial(recalib.ProgramStation, ["a\0b"]),
        "half a measurement": partial(recalib.train, plant, learner, poses, poses, [0.5]),
        "one pose for many": partial(controller.inverse, np.eye(4)),
        "five coordinates": partial(robot.workspace.to_poses, np.zeros(5)),
        "a point for a pose": partial(recalib.position_error, np.zeros(3), np.zeros(3)),
        "a mirrored workspace": partial(recalib.Workspace, np.eye(4), -np.ones(6)),
        "half a cell": partial(recalib.Rules, *[True] * 4, supernet=(1.5, 3, 3)),
        "a word for a switch": partial(recalib.Rules, "no", True, True, True),
        "a narrow field": partial(recalib.RadialLearner, rules, schedule, -1.0),
        "a row too few": partial(recalib.Observations, joints, joints[:2, :3]),
        "rates of two runs for three": partial(
            recalib.HierarchicalLearner,
            rules,
            recalib.Schedule(**good | {"initial_rate": np.array([0.9, 0.8])}),
            runs=3,
        ),
        "frames of the wrong arm": partial(recalib.initial_frames, robot, arrays),
    }


def is_refused(call: Callable[[], object]) -> bool:
    """Whether a call is refused with what was expected."""
    try:
        call()
    except recalib.RecalibError as error:
        return "expected: " in str(error)
    return False


def test_a_wrong_call_is_refused_with_what_was_expected():
    assert not [name for name, call in wrong_calls().items() if not is_refused(call)]


MISUSE = """
import recalib

def robots(one: recalib.Plant, own: recalib.ExternalRobot) -> None:
    taken: list[recalib.Commandable] = [one, own]

recalib.Controller(3, nonsense=4)
recalib.load_robott("ur10_robot.urdf")
"""


@pytest.mark.slow
def test_a_type_checker_knows_the_public_names_and_finds_no_fault_with_the_examples(tmp_path):
    pytest.importorskip("mypy", reason="needs mypy, of the extra dev")
    (tmp_path / "misuse.py").write_text(MISUSE)
    checked = run(sys.executable, "-m", "mypy", "examples", tmp_path / "misuse.py")
    # not the whole path: of the same text, mypy's cache still knows the one of the last run
    faults = re.findall(r"(\w+)\.py:(\d+): error:", checked.stdout)
    assert faults == [("misuse", "7"), ("misuse", "7"), ("misuse", "8")], checked.stdout
    assert "nonsense" in checked.stdout and "load_robott" in checked.stdout


@pytest.mark.slow
@pytest.mark.parametrize("name", EXAMPLES)
def test_an_example_ends_with_small_errors(name, monkeypatch, capsys):
    path = ROOT / "examples" / f"{name}.py"
    assert len(path.read_text().splitlines()) <= 30
    monkeypatch.syspath_prepend(path.parent)
    monkeypatch.setattr("matplotlib.pyplot.show", lambda: None)
    runpy.run_path(str(path))
    output = capsys.readouterr().out
    errors = [float(number) for number in re.findall(r"([\d.]+) (?:mm|cm)", output)]
    assert 0 <= errors[-1] < 0.1 * errors[0]
    if name == "save_and_load":
        assert "belongs to another robot: its home differs by up to 0.1" in output


@pytest.fixture(scope="module")
def committed() -> set[str]:
    """The paths of all files that git holds, or would."""
    listed = run("git", "ls-files", "--cached", "--others", "--exclude-standard")
    if listed.returncode:
        pytest.skip("this copy is no git repository")
    return {path for path in listed.stdout.splitlines() if (ROOT / path).is_file()}


@pytest.fixture(scope="module")
def released(committed, tmp_path_factory) -> Path:
    """A folder with the sources that are released, and the wheel that is made of them."""
    folder = tmp_path_factory.mktemp("released")
    source = folder / "source"
    for path in committed:
        (source / path).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / path, source / path)
    for name in ("kept.nbi", "kept.1.nbc", "kept.pyc"):  # what Numba and Python keep of a use
        (source / "recalib" / "__pycache__").mkdir(exist_ok=True)
        (source / "recalib" / "__pycache__" / name).touch()
    build = [sys.executable, "-m", "build", "--no-isolation", "--outdir", folder, source]
    subprocess.run(build, cwd=folder, check=True)
    return folder


@pytest.mark.slow
def test_the_sources_that_are_released_are_what_git_holds(released, committed):
    (path,) = released.glob("*.tar.gz")
    with tarfile.open(path) as archive:
        files = {file.name.partition("/")[2] for file in archive if file.isfile()}
    built = {file for file in files if file.startswith("recalib.egg-info/")}
    assert files - built - {"PKG-INFO", "setup.cfg"} == committed


@pytest.mark.slow
def test_the_wheel_works_where_nothing_of_the_studies_is(released, tmp_path):
    (wheel,) = released.glob("*.whl")
    pip = [sys.executable, "-m", "pip", "--quiet", "--disable-pip-version-check"]
    alone = "--no-index", "--no-deps", "--target", tmp_path
    subprocess.run([*pip, "install", *alone, wheel], check=True)
    code = f"""
import runpy, sys
from pathlib import Path
sys.modules |= dict.fromkeys({FOR_STUDIES})
import recalib
from recalib.station import cells_of
assert recalib.__file__.startswith("{tmp_path}"), recalib.__file__
assert not Path(recalib.__file__).with_name("study").exists()
for name in {{*recalib.__all__}} - {{"calibrate_pictures"}}:  # which needs OpenCV
    getattr(recalib, name)
runpy.run_path("save_and_load.py")
"""
    examples = shutil.copytree(ROOT / "examples", tmp_path / "examples")
    only = os.environ | {"PYTHONPATH": str(tmp_path)}
    output = run(sys.executable, "-c", code, cwd=examples, env=only, check=True).stdout
    assert "commanded corrected: mean error 0.0000" in output


@pytest.mark.slow
def test_the_page_on_ones_own_arm_holds_where_only_the_wheel_is(released, tmp_path):
    """In an environment that begins empty, away from the sources."""
    (wheel,) = released.glob("*.whl")
    programs = tmp_path / "environment" / "bin"
    uv = Path(sys.executable).with_name("uv")
    subprocess.run([uv, "venv", "--quiet", "--python", sys.executable, programs.parent], check=True)
    lock = f"--constraint={ROOT / 'requirements.lock'}"
    into = "--quiet", "--python", programs / "python", lock
    subprocess.run([uv, "pip", "install", *into, f"{wheel}[laboratory]"], check=True)

    description = find_urdf("ur10_robot.urdf")
    shutil.copy(description, tmp_path / "ARM.urdf")
    arm = recalib.load_arm(description, "tool0")
    random = np.random.default_rng(4)
    joints = np.array([0, -1.2, 1.5, -0.3, 1.5, 0]) + random.uniform(-0.6, 0.6, (40, 6))
    offsets = np.array([0, -0.02, 0.015, 0.02, -0.01, 0])
    reached = arm.forward(joints + offsets)[:, :3, 3]
    write(tmp_path / "measurements.csv", in_degrees(arm, joints) | in_millimetres(reached))
    write(tmp_path / "desired.csv", in_millimetres(reached[:5]))

    page = (ROOT / "docs" / "own_arm.md").read_text(encoding="utf-8")
    block = re.search(r"```sh\n(.*?)```", page, re.DOTALL)[1]
    commands = [line.partition("#")[0].split() for line in block.splitlines()]
    assert [command[:2] for command in commands[1:]] == [
        ["recalib", "calibrate"],
        ["recalib", "next"],
        ["recalib", "correct"],
    ]
    clean = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    for program, *arguments in commands[1:]:
        subprocess.run([programs / program, *arguments], cwd=tmp_path, env=clean, check=True)
    sent = pd.read_csv(tmp_path / "commands.csv")
    commanded = np.radians([sent[f"{joint} [deg]"] for joint in arm.joints]).T
    hit = arm.forward(commanded + offsets)[:, :3, 3]
    assert np.abs(hit - reached[:5]).max() < 1e-3 < np.ptp(arm.forward(commanded)[:, :3, 3] - hit)
    made = {path.name for path in (tmp_path / "calibration").iterdir()}
    assert {"page.html", "arm.urdf", "summary.txt"} <= made
