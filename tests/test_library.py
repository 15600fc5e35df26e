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
from collections.abc import Callable, Iterator
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


def wrong_calls() -> Iterator[tuple[Callable[..., object], tuple]]:
    """Calls with an argument of another kind, shape or size, and these arguments."""
    urdf = find_urdf("ur10_robot.urdf")
    home = {"shoulder_lift_joint": -1.4, "elbow_joint": 2.1, "wrist_1_joint": -2.9}
    home |= {"shoulder_pan_joint": 0.0, "wrist_2_joint": -1.57, "wrist_3_joint": 0.0}
    ranges = [0.3] * 3, [0.6] * 3
    load = partial(recalib.load_robot, urdf, "tool0")
    robot = load(home, *ranges)
    controller, pair, rules = recalib.Controller(robot), (1.0, 1.0), recalib.IMPROVED
    good = {"initial_width": 2.0, "initial_rate": 0.9, "final_rate": 0.5}
    good["final_widths"] = {"position": pair, "orientation": pair}
    schedule = recalib.Schedule(**good)
    learner = recalib.HierarchicalLearner(rules, schedule)
    plant, moved = (recalib.Plant(controller, recalib.apply(robot, [])) for _ in range(2))
    moved.execute(np.zeros((2, 1, 6)))
    poses, joints, chain = np.zeros((1, 2, 6)), np.zeros((3, 6)), recalib.Chain.of(robot.arm)
    own = recalib.ExternalRobot(robot.workspace, lambda pose: pose)
    arrays = recalib.Observations(joints, joints[:, :3])
    postures = np.random.default_rng(0).uniform(-1, 1, (12, 6)) + robot.home
    measured = recalib.Observations(postures, robot.arm.forward(postures))
    found = recalib.GeometricLearner.identify(robot.arm, measured)
    assert isinstance(recalib.HybridLearner.identify(robot.arm, measured), type(found))
    live = partial(recalib.calibrate_live, object, robot.arm, "never.csv")
    balls = {"sockets": ["a", "b"] * 6}

    def each(others: list, *calls: Callable[[object], object]) -> Iterator[tuple]:
        return ((call, (other,)) for call in calls for other in others)

    for key in good:
        yield from each(
            ["2", None, ["a", "b"], np.nan, 0],
            lambda it, key=key: recalib.Schedule(**good | {key: it}),
        )
    yield from each(
        [None, robot.arm, 3],
        recalib.Controller,
        recalib.arm_of_table,
        recalib.HybridLearner,
        recalib.Noise,
        lambda it: recalib.Plant(it, robot.arm),
        lambda it: recalib.HierarchicalLearner(it, schedule),
        lambda it: recalib.RadialLearner(it, schedule),
        lambda it: recalib.HierarchicalLearner(rules, it),
        lambda it: recalib.HybridLearner.identify(robot.arm, it),
        lambda it: recalib.train(plant, it, poses, poses, [1]),
        lambda it: recalib.ExternalRobot(robot.workspace, it),
        lambda it: recalib.apply(robot, [it]),
        lambda it: recalib.save(Path("never.npz"), learner, it),
        lambda it: recalib.load(Path("never.npz"), it),
        lambda it: recalib.Workspace(it, np.ones(6)),
        lambda it: recalib.Workspace(np.eye(4), it),
        lambda it: recalib.information_gains(it, joints),
        lambda it: recalib.initial_frames(robot.arm, it),
    )
    yield from each(
        [None, robot, 3, ["a", "b"], "arm"],
        recalib.Chain.of,
        chain.forward,
        plant.execute,
        plant.achieve,
        own.execute,
        controller.targets,
        robot.workspace.to_poses,
        cells_of,
        learner.command,
        recalib.PolynomialLearner(1).command,
        recalib.GaussianProcessLearner().command,
        recalib.RadialLearner(rules, schedule).command,
        live,
        lambda it: recalib.Chain.side_by_side([it]),
        lambda it: chain.solve(it, joints),
        lambda it: chain.solve(np.ones((3, 4, 4)), it),
        lambda it: recalib.Plant(controller, [it]),
        lambda it: recalib.Plant(controller, robot.arm, recalib.Disturbances(), [it]),
        lambda it: load(it, *ranges),
        lambda it: load(home, it, ranges[1]),
        lambda it: recalib.load_shapes(it, urdf),
        lambda it: recalib.arm_of_table([recalib.Row(it), recalib.Row(it)]),
        lambda it: recalib.arm_of_table([recalib.Row("a", slides=it)]),
        lambda it: recalib.train(plant, learner, poses, poses, it),
        lambda it: recalib.LiveSettings(box=np.eye(3) if it is None else it),
        lambda it: recalib.calibrate_live(object, it, "never.csv", recalib.LiveSettings()),
        lambda it: recalib.calibrate_live(it, robot.arm, "never.csv", recalib.LiveSettings()),
        lambda it: recalib.calibrate(it, postures, measured.measured),
        lambda it: recalib.calibrate(robot.arm, postures, measured.measured, on_progress=it),
        lambda it: recalib.calibrate(robot.arm, postures, **balls, distances={("a", "b"): it}),
        lambda it: recalib.ProgramStation([] if isinstance(it, list) else it),
        lambda it: learner.learn(it, plant.execute, 0.1),
        lambda it: recalib.GeometricLearner(controller).learn(it, plant.execute, 0.1),
    )
    rest, text = partial(recalib.Rules, True, True, True, True), ["fast", ["a"], np.nan]
    for call, keys, values in (
        (recalib.LiveSettings, "error span speed", [*text, np.inf, 0.0, -1e-3]),
        (recalib.LiveSettings, "most", [*text, 9]),
        (recalib.LiveSettings, "floor", text),
        (rest, "centres spread rate", ["cosine"]),
        (rest, "metric width_units", [(1, 1, 1), (1, 1, 1, 1, 1, 0)]),
        (rest, "supernet subnet", [(1.5, 3, 3), (3, 0, 3)]),
        (rest, "dimensions", [4]),
        (partial(recalib.Schedule, **good), "initial_rate", [0, 1.01]),
        (recalib.Noise, "position_noise orientation_noise", [-1e-4, np.nan]),
        (recalib.Repeatability, "repeatability", [np.inf]),
    ):
        for key in keys.split():
            yield from each(values, lambda it, call=call, key=key: call(**{key: it}))
    widths = [(0, 1), (1, -0.1), (1, [1, np.nan])]
    yield from each(widths, lambda it: recalib.Schedule(1.0, {"pose": it}, 0.5, 0.1))
    yield from each([1.1, "a"], lambda it: recalib.Outliers(it, 0.05))
    yield from each([-0.05, None], lambda it: recalib.Outliers(0.1, it))
    grids, row = [[0.5], [0, 3], [-1, 2], [], np.eye(2)], recalib.Row("a")
    yield from each(grids, lambda it: recalib.train(plant, learner, poses, poses, it))
    yield from each([[], [row, row], [recalib.Row("a", alpha=np.nan)]], recalib.arm_of_table)
    yield from each(["3 deg", None], lambda it: recalib.EncoderShift("elbow_joint", it))
    yield from each([joints[:, :5], joints[0]], lambda it: recalib.information_gains(found, it))
    yield from each([np.zeros((3, 1, 6)), np.zeros((1, 1, 6))], moved.execute)
    yield from each([(3, -3), 3], lambda it: load(home, *ranges, limits={"elbow_joint": it}))
    shapes = [np.zeros(shape) for shape in ((2, 6), (1, 2, 5), (1, 2, 7), (6,), (2, 1, 2, 6))]
    yield from each(shapes, plant.execute, plant.achieve, chain.forward)
    yield from each([np.zeros(5), np.zeros(7)], lambda it: recalib.Chain.of(robot.arm, it))
    radial, waits = recalib.RadialLearner(rules, schedule), recalib.GaussianProcessLearner()
    yield from each(
        [None, "x", [], {}, np.zeros(2), b"x"],
        lambda it: learner.learn(poses[:, 0], it, 0.0),
        lambda it: learner.learn(poses[:, 0], pytest.fail, it),
        lambda it: radial.learn(poses[:, 0], it, 0.0),
        lambda it: radial.learn(poses[:, 0], pytest.fail, it),
        lambda it: waits.learn(poses[:, 0], it, 0.0),
        lambda it: recalib.PolynomialLearner(it),
        lambda it: rest(centres=it),
        lambda it: rest(spread=it),
        lambda it: rest(dimensions=it),
        lambda it: recalib.HierarchicalLearner(rules, schedule, runs=it),
    )
    three = recalib.Plant(controller, [recalib.apply(robot, [])] * 3)
    two_rates = recalib.Schedule(**good | {"initial_rate": np.array([0.9, 0.8])})
    for call in (
        lambda: chain.forward(np.zeros((2, 2, 6))),
        lambda: chain.solve(np.ones((2, 4, 4)), np.zeros((2, 7))),
        lambda: chain.solve(np.ones((1, 4, 4)), np.zeros((2, 6))),
        lambda: recalib.HierarchicalLearner(rules, schedule, runs=True),
        lambda: recalib.GaussianProcessLearner(runs=0),
        lambda: recalib.PolynomialLearner(1, runs=0.5),
        lambda: recalib.PolynomialLearner(3),
        lambda: recalib.HybridLearner.identify(robot, arrays),
        lambda: recalib.train(learner, plant, poses, poses, [1]),
        lambda: recalib.apply(robot, recalib.Noise()),
        lambda: recalib.Plant(controller, []),
        lambda: recalib.Chain.side_by_side([]),
        lambda: recalib.Plant(controller, robot.arm, recalib.Disturbances()),
        lambda: three.execute(np.zeros((2, 1, 6))),
        lambda: recalib.position_error(np.ones((3, 4, 4)), np.ones((2, 4, 4))),
        lambda: load(home, *ranges, beyond="10 cm"),
        lambda: recalib.ProgramStation(["a\0b"]),
        lambda: load(home, *ranges, name=np.ones(2)),
        lambda: controller.inverse(np.eye(4)),
        lambda: robot.workspace.to_poses(np.zeros(5)),
        lambda: recalib.position_error(np.zeros(3), np.zeros(3)),
        lambda: recalib.Workspace(np.eye(4), -np.ones(6)),
        lambda: recalib.Workspace(np.eye(4), np.full(6, 0.1), "quaternion"),
        lambda: recalib.arm_of_table([recalib.Row("a")], "craig"),
        lambda: recalib.Rules("no", True, True, True),
        lambda: recalib.RadialLearner(rules, schedule, -1.0),
        lambda: recalib.Observations(joints, joints[:2, :3]),
        lambda: recalib.HierarchicalLearner(rules, two_rates, runs=3),
        lambda: recalib.initial_frames(robot, arrays),
    ):
        yield call, ()


def is_refused(call: Callable[..., object], arguments: tuple) -> bool:
    """Whether a call is refused with what was expected."""
    try:
        call(*arguments)
    except recalib.RecalibError as error:
        return "expected: " in str(error)
    return False


def test_a_wrong_call_is_refused_with_what_was_expected():
    taken = [wrong for wrong in wrong_calls() if not is_refused(*wrong)]
    assert not [(getattr(call, "__code__", call), arguments) for call, arguments in taken], (
        "the code of a lambda has its line"
    )


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
    given = [" ".join(command[:2]) for command in commands[1:]]
    assert given == ["recalib calibrate", "recalib next", "recalib correct"]
    clean = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    for program, *arguments in commands[1:]:
        subprocess.run([programs / program, *arguments], cwd=tmp_path, env=clean, check=True)
    sent = pd.read_csv(tmp_path / "commands.csv")
    commanded = np.radians([sent[f"{joint} [deg]"] for joint in arm.joints]).T
    hit = arm.forward(commanded + offsets)[:, :3, 3]
    assert np.abs(hit - reached[:5]).max() < 1e-3 < np.ptp(arm.forward(commanded)[:, :3, 3] - hit)
    made = {path.name for path in (tmp_path / "calibration").iterdir()}
    assert {"page.html", "arm.urdf", "summary.txt"} <= made
