"""What was learned comes back from its file as it was, for the robot that it was learned on."""

import json
import tempfile
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import recalib
from recalib.learners import KINDS, VERSION, class_of, kind_of, read
from tests.spoiling import spoil

RUNS = 2
DESIRED = np.random.default_rng(1).uniform(-1, 1, (RUNS, 20, 6))
TESTS = np.random.default_rng(2).uniform(-1, 1, (RUNS, 20, 6))


@pytest.fixture(scope="module")
def plant(controller, robot) -> recalib.Plant:
    """A robot with something for a Gaussian process, too."""
    return recalib.Plant(
        controller, recalib.apply(robot, [recalib.EccentricGear("elbow_joint", 0.02)])
    )


def train(learner, plant, moves, first=0, run=slice(None)):
    for move in range(first, moves):
        learner.learn(DESIRED[run, move], plant.execute, move / moves)
    return learner


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(("moves", "more"), [(0, 6), (19, 1)])
def test_a_learner_goes_on_from_its_file(kind, moves, more, makers, plant, robot, tmp_path):
    learner = train(makers[kind](runs=RUNS), plant, moves)
    recalib.save(tmp_path / "a.npz", learner, robot)
    loaded = recalib.load(tmp_path / "a.npz", robot)
    assert type(loaded) is type(learner)
    assert json.dumps(loaded.settings()) == json.dumps(learner.settings())
    assert np.array_equal(loaded.command(TESTS), learner.command(TESTS))
    for trained in (learner, loaded):
        train(trained, plant, moves + more, first=moves)
    assert np.array_equal(loaded.command(TESTS), learner.command(TESTS))


@pytest.mark.parametrize("kind", KINDS)
def test_one_run_of_several_is_taken(kind, makers, plant, robot, tmp_path):
    learner = train(makers[kind](runs=RUNS), plant, 5)
    recalib.save(tmp_path / "both.npz", learner, robot)
    for run in range(RUNS):
        taken = recalib.load(tmp_path / "both.npz", robot, run)
        assert np.array_equal(taken.command(TESTS[[run]]), learner.command(TESTS)[[run]])
    with pytest.raises(recalib.InvalidSetting, match="run is 2; expected: 0 to 1"):
        recalib.load(tmp_path / "both.npz", robot, 2)


def longer(model) -> None:
    model.jointPlacements[3].translation[0] += 1e-3


def renamed(model) -> None:
    model.names[1] = "waist"


def with_arm(robot, change=lambda model: None, tool="tool0"):
    model = robot.arm.model.copy()
    change(model)
    return replace(robot, arm=recalib.Arm(model, tool, "base_link"))


def with_workspace(robot, **changes):
    return replace(robot, workspace=replace(robot.workspace, **changes))


OTHERS = {
    "kinematics differs": lambda robot: with_arm(robot, longer),
    "tool is tool0, not ee_link": lambda robot: with_arm(robot, tool="ee_link"),
    "joints are .*, not .*waist": lambda robot: with_arm(robot, renamed),
    r"home differs by up to 0\.1 m or rad": lambda robot: replace(
        robot, home=robot.home + 0.1 * np.eye(6)[2]
    ),
    "workspace differs": lambda robot: with_workspace(robot, coordinates="rotation_vector"),
    "workspace differs.*": lambda robot: with_workspace(
        robot, half_ranges=1.1 * robot.workspace.half_ranges
    ),
}


@pytest.mark.parametrize("message", OTHERS)
def test_another_robot_is_refused_with_what_differs(message, robot, tmp_path):
    recalib.save(tmp_path / "a.npz", recalib.PolynomialLearner(1), robot)
    with pytest.raises(
        recalib.OtherRobot, match=rf"a\.npz belongs to another robot: its {message}"
    ):
        recalib.load(tmp_path / "a.npz", OTHERS[message](robot))


def test_another_name_is_no_other_robot_but_a_newer_format_is_refused(robot, tmp_path):
    recalib.save(path := tmp_path / "a.npz", recalib.PolynomialLearner(1), robot)
    recalib.load(path, replace(robot, name="Marvin"))
    arrays = dict(np.load(path))
    header = json.loads(str(arrays.pop("header"))) | {"version": VERSION + 1}
    np.savez(path, header=json.dumps(header), **arrays)
    found = rf"format is \('recalib learner', {VERSION + 1}\)"
    with pytest.raises(recalib.InvalidFile, match=rf"{found}; expected: .* {VERSION}\)"):
        recalib.load(path, robot)


@pytest.fixture(scope="module", params=KINDS)
def written(request, makers, plant, robot, tmp_path_factory):
    path = tmp_path_factory.mktemp("written") / "a.npz"
    recalib.save(path, train(makers[request.param](runs=RUNS), plant, 7), robot)
    return path


@settings(max_examples=20)
@given(st.data())
def test_a_file_that_was_tampered_with_is_refused_or_of_use(written, robot, data):
    """Whatever was replaced in it, also where it was sealed anew."""
    with tempfile.TemporaryDirectory() as folder, np.errstate(all="ignore"):
        path = Path(folder) / "a.npz"
        path.write_bytes(written.read_bytes())
        spoil(data.draw, path)
        with suppress(recalib.RecalibError):
            learner, runs = recalib.load(path, robot), len(read(path)[1])
            assert learner.command(TESTS[:1].repeat(runs, axis=0)).shape == (runs, *TESTS.shape[1:])


def test_a_file_of_which_one_run_commands_no_number_is_refused(robot, tmp_path, monkeypatch):
    """As where its coefficients are huge."""
    recalib.save(tmp_path / "a.npz", recalib.PolynomialLearner(1, runs=2), robot)
    beyond = np.array([0, np.inf])[:, None, None]
    monkeypatch.setattr(
        recalib.PolynomialLearner, "command", lambda learner, desired: desired + beyond
    )
    with pytest.raises(recalib.InvalidFile):
        recalib.load(tmp_path / "a.npz", robot)


def test_what_cannot_be_loaded_is_not_saved(robot, tmp_path):
    with pytest.raises(recalib.UnknownName, match="UncorrectedLearner.*expected: gaussian_process"):
        recalib.save(tmp_path / "a.npz", recalib.UncorrectedLearner(), robot)
    assert not [*tmp_path.iterdir()]
    with pytest.raises(recalib.UnknownName, match=r"'hybird'; expected: .*; did you mean hybrid\?"):
        class_of("hybird")


def test_runs_keep_the_schedules_of_their_own_and_the_rules_that_they_share(robot, tmp_path):
    """As the winners of several searches have them."""
    rules = recalib.Rules(
        True, False, True, True, (2, 2, 2), (2, 2, 2), "faces", (0.3, 0.3, 0.3, 1, 1, 1), 6,
        "logarithms", "exponential",
    )  # fmt: skip
    own = recalib.Schedule(
        np.array([4.0, 3.0, 2.0]),
        {"position": (np.array([0.6, 0.7, 0.8]), 1.5), "orientation": (1.0, 1.0)},
        np.array([0.8, 0.9, 0.7]),
        0.4,
    )
    desired = np.random.default_rng(4).uniform(-1, 1, (3, 10, 6))

    def bend(commands):
        executed = np.ones(commands.shape[:2], dtype=bool)
        return recalib.Outcome(commands + 0.1 * np.sin(commands[..., ::-1]), executed)

    def go_on(learner, runs, moves):
        for move in moves:
            learner.learn(desired[runs, move], bend, move / 10)
        return learner

    together = go_on(recalib.HierarchicalLearner(rules, own, runs=3), [0, 1, 2], range(5))
    recalib.save(tmp_path / "together.npz", together, robot)
    loaded, last = (
        recalib.load(tmp_path / "together.npz", robot),
        recalib.load(tmp_path / "together.npz", robot, 2),
    )
    assert loaded.rules == rules and loaded.settings() == together.settings()
    for learner, runs in ((together, [0, 1, 2]), (loaded, [0, 1, 2]), (last, [2])):
        go_on(learner, runs, range(5, 10))
    tests = np.random.default_rng(5).uniform(-1, 1, (3, 20, 6))
    assert np.array_equal(loaded.command(tests), together.command(tests))
    assert np.array_equal(last.command(tests[[2]]), together.command(tests)[[2]])


def test_a_learner_is_of_the_kind_of_its_own_class():
    class Other(recalib.PolynomialLearner):
        pass

    assert kind_of(recalib.PolynomialLearner(1)) == "polynomial"
    with pytest.raises(recalib.UnknownName, match="unknown kind of learner to save 'Other'"):
        kind_of(Other(1))


@pytest.mark.parametrize("name", KINDS)
def test_what_is_learned_later_leaves_a_state_as_it_was(name, makers):
    learner, poses = makers[name](runs=2), np.random.default_rng(1).uniform(-1, 1, (2, 9, 6))

    def learn(moves):
        for move in moves:
            learner.learn(
                poses[:, move],
                lambda sent: recalib.Outcome(0.9 * sent, np.ones((2, 1), dtype=bool)),
                0.0,
            )

    learn(range(3))
    state, commands = learner.state(), learner.command(poses)
    learn(range(3, 9))
    assert not np.array_equal(learner.command(poses), commands)
    learner.restore(state)
    assert np.array_equal(learner.command(poses), commands)
