"""What a browser computes on the site is what the library computes."""

import json
import shutil
from dataclasses import replace
from functools import partial
from itertools import product
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

import recalib
from recalib.nominal import pose_errors
from replication.recording import script, typical_seed
from replication.scenarios import Resolved
from replication.training import Stream
from tests.conftest import ROOT, run
from tests.replication.recording.conftest import ITERATIONS, OWN, TESTS, WIDTHS

STUDY = ROOT / "docs" / "study.js"
SCRIPTS = [f"workflow/site/try/{name}.js" for name in ("arm", "plant", "map", "experiment")]
NODE = """const vm = require("vm"), fs = require("fs"), [asked, ...scripts] = process.argv.slice(1);
for (const path of scripts) vm.runInThisContext(fs.readFileSync(path, "utf8"), path);
process.stdout.write(JSON.stringify(vm.runInThisContext(asked)));"""
LINKS = ("upper_arm_link", "forearm_link", "wrist_1_link", "wrist_2_link")
LARGEST = [0.05] * 4 + [0.1, -0.1, 0.1, -0.1, 0.1, -0.1]  # as far as the sliders go: m, rad
close = partial(np.testing.assert_allclose, rtol=0, atol=1e-9)
needs_node = pytest.mark.skipif(not shutil.which("node"), reason="needs Node: Debian's nodejs")


@pytest.fixture(scope="module")
def written(small, files, tmp_path_factory) -> Path:
    """The script of the small study."""
    path = tmp_path_factory.mktemp("page") / "study.js"
    text = script(small, files.scenarios[0], files.settings, files.histories[0])
    path.write_text(text, encoding="utf-8")
    return path


def content(path: Path) -> SimpleNamespace:
    """What stands in a script."""
    text = path.read_text(encoding="utf-8")
    return SimpleNamespace(**json.loads(text.partition("STUDY = ")[2].rstrip(";\n")))


def in_node(written: Path, expression: str):
    """The value of an expression, with the study and all scripts but the page's there."""
    process = run("node", "-e", NODE, "--", expression, written, *SCRIPTS, check=True)
    return json.loads(process.stdout)


def damaged(robot, damage):
    short = [recalib.LinkShortening(*shortening) for shortening in zip(LINKS, damage, strict=False)]
    return recalib.apply(robot, [*short, *map(recalib.EncoderShift, robot.joints, damage[4:])])


@needs_node
def test_the_kinematics_are_those_of_the_library(robot, controller, written):
    plant = damaged(robot, LARGEST)
    expression = f"""(() => {{
      const {{ controller, tests }} = new Experiment(STUDY);
      const plant = new Plant(controller, STUDY.robot.links, {LARGEST});
      const {{ workspace }} = controller;
      return tests.map(({{ u, angles, pose }}) => ({{
        angles, pose, achieved: [...plant.achieve(angles)],
        coordinates: workspace.toCoordinates(plant.achieve(angles)),
        errors: errors(plant.achieve(angles), pose) }}));
    }})()"""
    found = pd.DataFrame(in_node(written, expression))
    tests = np.array(content(written).tests)
    desired, angles = robot.workspace.to_poses(tests), controller.targets(tests[None]).angles[0]
    achieved = plant.forward(angles)
    close(np.stack(found["pose"]), desired[:, :3].reshape(-1, 12))
    close(np.stack(found["angles"]), angles)
    close(np.stack(found["achieved"]), achieved[:, :3].reshape(-1, 12))
    close(np.stack(found["coordinates"]), robot.workspace.to_coordinates(achieved))
    position, orientation = pose_errors(robot.workspace, achieved, desired)
    close(np.stack(found["errors"]), np.stack([100 * position, np.degrees(orientation)], axis=1))


@pytest.fixture(scope="module")
def narrow(robot, controller) -> recalib.Controller:
    """That of a robot whose joints turn no farther than its workspace needs."""
    corners = robot.workspace.to_poses(np.array([*product((-1.0, 0.0, 1.0), repeat=6)]))
    angles = controller.inverse(corners)
    limits = {"lower": angles.min(axis=0) - 1e-6, "upper": angles.max(axis=0) + 1e-6}
    return recalib.Controller(replace(robot, **limits))


@needs_node
@pytest.mark.parametrize("name", ["as far as the sliders go", "beyond limits"])
def test_every_measurement_of_a_training_is_that_of_the_library(name, request):
    controller = request.getfixturevalue("narrow" if name == "beyond limits" else "controller")
    robot, limits = controller.robot, ("lower", "upper")
    bounds = json.dumps({limit: getattr(robot, limit).tolist() for limit in limits})
    expression = (
        f"Object.assign(STUDY.robot, {bounds}) && [...new Experiment(STUDY).train({LARGEST})]"
    )
    found = pd.DataFrame(in_node(STUDY, expression))
    plant, training = recalib.Plant(controller, damaged(robot, LARGEST)), content(STUDY)
    learner = recalib.HierarchicalLearner(recalib.IMPROVED, recalib.Schedule(**training.schedule))
    poses, measure_at = map(np.array, (training.desired, training.tests)), range(0, 201, 4)
    history = recalib.train(plant, learner, *poses, measure_at)
    assert len(found) == len(measure_at) == 51
    assert (history.refused[-1] > 0) == (name == "beyond limits")
    close(found["position"], 100 * history.position_error)
    close(found["orientation"], np.degrees(history.orientation_error))


@needs_node
def test_an_identification_finds_the_damage_and_leaves_nothing(written):
    damages = LARGEST, [0.0] * 10, [0.01, 0.0, 0.02, 0.04, 0.0, -0.07, 0.0, 0.03, 0.0, 0.05]
    experiment = "new Experiment(STUDY)"
    expressions = (
        f"[{experiment}.identify({damage}), {experiment}.identified({damage})]"
        for damage in damages
    )
    found = in_node(written, f"[{', '.join(expressions)}]")
    for damage, (identified, residuals) in zip(damages, found, strict=True):
        close(identified, damage)
        close([residuals["position"], residuals["orientation"]], 0)


def test_what_is_written_is_the_recorded_training_and_what_is_shipped_the_studys(
    small, files, tmp_path, study, robot
):
    entries = (
        recalib.LinkShortening("wrist_1_link", 0.01),
        recalib.EncoderShift("elbow_joint", 0.02),
    )
    resolved = Resolved.read(files.scenarios[0]).model_copy(update={"damages": entries})
    (tmp_path / "scenario.json").write_text(resolved.model_dump_json())
    text = script(small, tmp_path / "scenario.json", files.settings, files.histories[0])
    (tmp_path / "study.js").write_text(text)
    training = content(tmp_path / "study.js")
    close(training.damage, [0, 0, 0.01, 0, 0, 0, 0.02, 0, 0, 0])
    assert training.iterations == ITERATIONS and training.schedule["initial_width"] == 3.8
    assert training.schedule["final_widths"]["position"] == [*WIDTHS["position"]]
    seed = typical_seed(pd.read_parquet(files.histories[0]))
    poses = Stream.SCENARIO.draw(small.seed, [seed], ITERATIONS, TESTS, scenario=OWN)
    assert training.desired == poses.desired[0].tolist()
    assert training.tests == poses.tests[0].tolist()
    shipped, seeds = content(STUDY), range(study.training.seeds)
    poses = Stream.SCENARIO.draw(study.seed, seeds, 200, 200, scenario=study.scenario)
    assert shipped.desired in poses.desired.tolist() and shipped.tests in poses.tests.tolist()
    assert [link for link, _ in shipped.robot["links"]] == [*LINKS]
    close(shipped.robot["home"], robot.home)
