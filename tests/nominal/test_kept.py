"""All that nominal arms, workspaces and controllers compute, as it is kept in files."""

import re

import numpy as np
import pytest

from recalib.errors import RecalibError
from recalib.nominal.arms import load_arm
from recalib.nominal.chain import Chain
from recalib.nominal.controller import Controller
from recalib.nominal.meshes import mesh_files, with_own_meshes
from recalib.nominal.newton import solve_groups
from recalib.nominal.robots import link_end, load_robot, shown
from tests.arms import SCARA, panda
from tests.kept import plain

HOME = np.radians([20, -75, 115, -130, -80, 15])
UR10 = "ur10_robot.urdf"


@pytest.fixture(scope="module")
def robot():
    home = dict(zip(load_arm(UR10, "tool0").joints, HOME, strict=True))
    return load_robot(
        UR10,
        "tool0",
        home,
        [0.4, 0.5, 0.3],
        np.radians([30, 40, 50]),
        limits={"elbow_joint": (0.4, 2.9), "wrist_1_joint": (-3.5, -0.9)},
        name="worker",
        coordinates="rotation_vector",
        beyond=0.07,
    )


def test_a_robot_is_as_kept(robot, data_regression):
    model = robot.arm.model
    found = {
        "name": [robot.name, robot.urdf.name, robot.joints],
        "numbers": [robot.home, robot.lower, robot.upper, robot.workspace],
        "links": robot.links,
        "ends": [
            link_end(model, robot.arm.tool, joint).translation for joint in range(model.njoints)
        ],
        "shown": [shown(0.1234, slides, digits) for slides in (0, 1) for digits in (".1f", ".4g")],
        "plain": load_robot(
            UR10, "tool0", dict(zip(robot.joints, HOME, strict=True)), *2 * [[1.0] * 3]
        ).name,
        "meshes": [path.name for path in mesh_files(robot.urdf)],
        "drawn": with_own_meshes(robot.urdf.read_bytes(), robot.urdf)[0].count(b"<mesh"),
        "left out": with_own_meshes(robot.urdf.read_bytes(), robot.urdf)[1],
    }
    data_regression.check(plain(found))


def commands(seed: int, *shape: int) -> np.ndarray:
    """Inside, a little beyond, far out of reach, and turned about by more than a right angle."""
    sample = np.random.default_rng(seed).uniform(-1, 1, (*shape, 6))
    sample[..., 1, :] *= 1.7
    sample[..., 2, :] *= 9
    sample[..., 3, 3:] *= 5
    return sample


@pytest.mark.parametrize("which", ["worker", "panda"])
def test_what_a_controller_answers_is_as_kept(which, robot, data_regression):
    its = robot if which == "worker" else panda()
    controller, workspace = Controller(its), its.workspace
    asked = commands(7, 2, 9)
    targets = controller.targets(asked)
    solution = controller.solve(workspace.to_poses(asked.reshape(-1, 6)))
    tilt = 0.02 * np.sin(np.arange(len(its.joints)) + 1)
    good = asked[:, 4:]
    found = {
        "angles": np.where(targets.executed[..., None], targets.angles, 0),
        "executed": targets.executed,
        "reached": solution.reached,
        "within": solution.within_limits,
        "residuals": np.where(solution.reached, 0, 1),
        "commands": controller.commands_for(good, lambda angles: angles * 1.01 + tilt),
        "inverse": controller.inverse(workspace.to_poses(good[0])),
    }
    for name, pose in (("far", asked[0, 2]), ("limit", np.array([0.9, 1.5, -2.2, 1.2, 2, -2.0]))):
        try:
            controller.inverse(workspace.to_poses(pose[None]))
        except RecalibError as error:
            found[name] = str(error).partition("(residual")[0]
    data_regression.check(plain(found))


def why(do, *arguments) -> str:
    """The reason for which something is refused, without what rounding decides."""
    with pytest.raises(RecalibError) as refused:
        do(*arguments)
    said = re.sub(r"/\S*/", "", str(refused.value)).partition(". pose at")[0]
    return re.sub(r"reach \d+ of", "reach # of", said)


def test_newtons_first_steps_from_afar_are_as_kept(data_regression):
    """From postures that are turned by more than a right angle, and singular ones."""
    arm, rng = load_arm(UR10, "tool0"), np.random.default_rng(9)
    goals = arm.forward(HOME + rng.uniform(-0.3, 0.3, (6, 6)))
    start = HOME + rng.uniform(-1.4, 1.4, (6, 6))
    start[2:4] = 0.0, -1.2, 0.0, 0.3, 0.0, 0.1
    found = []
    for steps in (1, 2, 4):

        def kinematics(groups, asked):
            pairs = [arm.forward_and_jacobian(its) for its in asked]
            return tuple(map(np.stack, zip(*pairs, strict=True)))

        pairs = goals.reshape(3, 2, 4, 4), start.reshape(3, 2, 6)
        found.append(solve_groups(kinematics, *pairs, 1e-11, steps))
    angles, errors = Chain.of(arm).solve(goals, start)
    reached = errors < 1e-9
    data_regression.check(plain([found, reached, np.round(angles[reached], 6)]))


GRIPPER = """<link name="hand"/><joint name="grip" type="revolute"><parent link="link_2"/>
<child link="hand"/><limit lower="0" upper="1" effort="1" velocity="1"/></joint></robot>"""
CHANGES = {
    "far": ("0.35 0 0", "1350 0 0"),
    "heavy": ('mass value="0.0"', 'mass value="1e7"'),
    "lever": ('<mass value="0.0"/>', '<origin xyz="0 1350 0"/><mass value="1"/>'),
    "forked": ("</robot>", GRIPPER),
    "no urdf": ("</robot>", ""),
    "nothing": ("link", "box"),
}


def test_why_arms_are_refused_is_as_kept(load, data_regression):
    said = {name: why(load, SCARA.replace(*CHANGES[name])) for name in CHANGES}
    still = re.sub("revolute|continuous|prismatic", "fixed", SCARA)
    said["still"] = why(load, still, "link_5")
    data_regression.check(said)
