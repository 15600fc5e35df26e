"""What a browser computes on the site is what the library computes."""

import json
import shutil
import subprocess
from dataclasses import replace
from functools import partial
from itertools import product
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from recalib.damaged.damage import EncoderShift, LinkShortening, apply
from recalib.damaged.plant import Plant
from recalib.learners.hierarchical import HierarchicalLearner
from recalib.learners.rules import IMPROVED
from recalib.learners.schedules import Schedule
from recalib.loop.training import train
from recalib.nominal.controller import Controller
from recalib.nominal.poses import pose_errors
from replication.recording.in_browser import script
from replication.training.poses import Stream
from replication.training.samples import winners
from replication.training.trainings import measuring, rules
from tests.conftest import ROOT

STUDY = ROOT / "docs" / "study.js"
SCRIPTS = [f"workflow/site/try/{name}.js" for name in ("arm", "plant", "map", "experiment")]
NODE = """const vm = require("vm"), fs = require("fs"), [asked, ...scripts] = process.argv.slice(1);
for (const path of scripts) vm.runInThisContext(fs.readFileSync(path, "utf8"), path);
process.stdout.write(JSON.stringify(vm.runInThisContext(asked)));"""
LINKS = ("upper_arm_link", "forearm_link", "wrist_1_link", "wrist_2_link")
LARGEST = [0.05] * 4 + [0.1, -0.1, 0.1, -0.1, 0.1, -0.1]  # as far as the sliders go: m, rad
close = partial(np.testing.assert_allclose, rtol=0, atol=1e-9)
needs_node = pytest.mark.skipif(not shutil.which("node"), reason="needs Node: Debian's nodejs")


def in_node(asked: str):
    """The value of an expression, with the study and all scripts but the page's there."""
    ran = subprocess.run(
        ["node", "-e", NODE, "--", asked, str(STUDY), *SCRIPTS],
        cwd=ROOT,
        text=True,
        capture_output=True,
        check=True,
    )
    return json.loads(ran.stdout)


@pytest.fixture(scope="module")
def shipped() -> SimpleNamespace:
    """What stands in the committed script."""
    text = STUDY.read_text(encoding="utf-8")
    return SimpleNamespace(**json.loads(text.partition("STUDY = ")[2].rstrip(";\n")))


def damaged(robot, damage):
    short = [LinkShortening(*its) for its in zip(LINKS, damage, strict=False)]
    return apply(robot, [*short, *map(EncoderShift, robot.joints, damage[4:])])


@needs_node
def test_the_kinematics_are_those_of_the_library(robot, controller, shipped):
    plant = damaged(robot, LARGEST)
    asked = f"""(() => {{
      const {{ controller, tests }} = new Experiment(STUDY);
      const its = new Plant(controller, STUDY.robot.links, {LARGEST}), {{ workspace }} = controller;
      return tests.map(({{ u, angles, pose }}) => ({{
        angles, pose, achieved: [...its.achieve(angles)],
        coordinates: workspace.toCoordinates(its.achieve(angles)),
        errors: errors(its.achieve(angles), pose) }}));
    }})()"""
    found = pd.DataFrame(in_node(asked))
    tests = np.array(shipped.tests)
    desired, angles = robot.workspace.to_poses(tests), controller.targets(tests[None]).angles[0]
    achieved = plant.forward(angles)
    close(np.stack(found["pose"]), desired[:, :3].reshape(-1, 12))
    close(np.stack(found["angles"]), angles)
    close(np.stack(found["achieved"]), achieved[:, :3].reshape(-1, 12))
    close(np.stack(found["coordinates"]), robot.workspace.to_coordinates(achieved))
    position, orientation = pose_errors(robot.workspace, achieved, desired)
    close(np.stack(found["errors"]), np.stack([100 * position, np.degrees(orientation)], axis=1))


@pytest.fixture(scope="module")
def narrow(robot, controller) -> Controller:
    """That of a robot whose joints turn no farther than its workspace needs."""
    corners = robot.workspace.to_poses(np.array([*product((-1.0, 0.0, 1.0), repeat=6)]))
    angles = controller.inverse(corners)
    limits = {"lower": angles.min(axis=0) - 1e-6, "upper": angles.max(axis=0) + 1e-6}
    return Controller(replace(robot, **limits))


@needs_node
@pytest.mark.parametrize("name", ["as far as the sliders go", "beyond limits"])
def test_every_measurement_of_a_training_is_that_of_the_library(name, request, shipped):
    controller = request.getfixturevalue("narrow" if name == "beyond limits" else "controller")
    robot, limits = controller.robot, ("lower", "upper")
    bounds = json.dumps({its: getattr(robot, its).tolist() for its in limits})
    asked = f"Object.assign(STUDY.robot, {bounds}) && [...new Experiment(STUDY).train({LARGEST})]"
    found = pd.DataFrame(in_node(asked))
    plant = Plant(controller, damaged(robot, LARGEST))
    learner = HierarchicalLearner(IMPROVED, Schedule(**shipped.schedule))
    poses, measure_at = map(np.array, (shipped.desired, shipped.tests)), range(0, 201, 4)
    history = train(plant, learner, *poses, measure_at)
    assert len(found) == len(measure_at) == 51
    assert (history.refused[-1] > 0) == (name == "beyond limits")
    close(found["position"], 100 * history.position_error)
    close(found["orientation"], np.degrees(history.orientation_error))


@needs_node
def test_an_identification_finds_the_damage_and_leaves_nothing():
    damages = LARGEST, [0.0] * 10, [0.01, 0.0, 0.02, 0.04, 0.0, -0.07, 0.0, 0.03, 0.0, 0.05]
    its = "new Experiment(STUDY)"
    asked = (f"[{its}.identify({damage}), {its}.identified({damage})]" for damage in damages)
    found = in_node(f"[{', '.join(asked)}]")
    for damage, (identified, left) in zip(damages, found, strict=True):
        close(identified, damage)
        close([left["position"], left["orientation"]], 0)


def test_what_is_written_is_the_recorded_run(plan, study, tmp_path):
    """That of the first seed of the typical search: here, the third of three."""
    table = pd.DataFrame({"search": [1, 1, 2, 2, 3, 3], "seed": range(6), "iteration": 200})
    errors = [0.1, 0.1, 0.3, 0.3, 0.2, 0.2]
    table = table.assign(position_error_cm=errors, orientation_error_deg=errors)
    history, scenario = tmp_path / "improved.parquet", tmp_path / "scenario.json"
    table.to_parquet(history)
    entries = (
        {"link": "wrist_1_link", "shorten": "1 cm"},
        {"encoder": "elbow_joint", "shift": "2 deg"},
    )
    resolved = plan.resolved("intact").model_dump(mode="json") | {"damages": entries}
    scenario.write_text(json.dumps(resolved), encoding="utf-8")
    sample, learner = ROOT / "workflow" / "search" / "improved_200.csv", rules(study, "improved")
    text = script(scenario, sample, history, learner, measuring(study), study.seed)
    its = json.loads(text.partition("STUDY = ")[2].rstrip(";\n"))
    assert its["run"] == 4
    assert its["schedule"]["initial_width"] == winners(sample)[2]["initial_width"]
    close(its["damage"], [0, 0, 0.01, 0, 0, 0, np.radians(2), 0, 0, 0])
    poses = Stream.SCENARIO.draw(study.seed, [4], 200, 200, scenario="intact")
    assert its["desired"] == poses.desired[0].tolist() and its["tests"] == poses.tests[0].tolist()


def test_what_is_shipped_is_of_the_study(study, robot, shipped):
    poses = Stream.SCENARIO.draw(study.seed, [shipped.run], 200, 200, scenario=study.scenario)
    assert shipped.desired == poses.desired[0].tolist() and shipped.tests == poses.tests[0].tolist()
    best = winners(ROOT / "workflow" / "search" / "improved_200.csv")[shipped.run // 5]
    assert shipped.schedule["final_rate"] == best["final_rate"]
    assert [link for link, _ in shipped.robot["links"]] == [*LINKS]
    close(shipped.robot["home"], robot.home)
