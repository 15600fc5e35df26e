"""Arms with other than six joints that turn: small ones as URDFs, and a Panda."""

from collections.abc import Iterable
from pathlib import Path

import numpy as np
import yaml

from recalib import Robot, load_robot

# of example-robot-data
LIBRARY = yaml.safe_load(Path(__file__).with_name("arms_of_example_robot_data.yaml").read_text())
PANDA = [f"panda_joint{index}" for index in range(1, 8)]


def urdf(*joints: Iterable[str], mass: float = 0.0) -> str:
    """A chain of links base, link_1, ... link_n of a mass [kg].

    Joints have name, kind, axis and origin each, and what else is to stand in them.
    """
    text = '<robot name="small"><link name="base"/>'
    for index, (name, kind, axis, xyz, *more) in enumerate(joints, start=1):
        parent = f"link_{index - 1}" if index > 1 else "base"
        text += f"""
<link name="link_{index}"><inertial><mass value="{mass}"/>
  <inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/></inertial></link>
<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="link_{index}"/>
  <axis xyz="{axis}"/><origin xyz="{xyz}" rpy="0 0 0"/>
  <limit lower="-2" upper="2" effort="1" velocity="1"/>{"".join(more)}</joint>"""
    return text + "</robot>"


SCARA = urdf(
    ("shoulder", "revolute", "0 0 1", "0 0 0.4"),
    ("elbow", "continuous", "0 0 1", "0.35 0 0"),
    ("quill", "prismatic", "0 0 -1", "0.25 0 0"),
    ("wrist", "revolute", "0 0 1", "0 0 -0.1"),
    ("flange", "fixed", "0 0 1", "0 0 -0.05"),
)
GANTRY = urdf(
    ("x", "prismatic", "1 0 0", "0 0 1"),
    ("y", "prismatic", "0 1 0", "0 0 0"),
    ("z", "prismatic", "0 0.6 0.8", "0 0 0"),  # leans
)
# Axes as most makers of industrial arms draw them: the last one lies along x of the link before it.
INDUSTRIAL = urdf(
    ("joint_1", "revolute", "0 0 1", "0 0 0.35"),
    ("joint_2", "revolute", "0 1 0", "0.1 0 0.1"),
    ("joint_3", "revolute", "0 1 0", "0 0 0.36"),
    ("joint_4", "revolute", "1 0 0", "0.2 0 0.07"),
    ("joint_5", "revolute", "0 1 0", "0.2 0 0"),
    ("joint_6", "revolute", "1 0 0", "0.08 0 0"),
)
# Six joints that turn, on a rail.
RAILED = urdf(
    ("rail", "prismatic", "0 1 0", "0 0 0.1"),
    ("pan", "revolute", "0 0 1", "0 0 0"),
    ("lift", "revolute", "0 1 0", "0 0.2 0"),
    ("elbow", "revolute", "0 1 0", "0.6 0 0"),
    ("bend", "revolute", "0 1 0", "0.55 -0.1 0"),
    ("twist", "revolute", "0 0 1", "0 0.1 0"),
    ("turn", "revolute", "1 0 0", "0.1 0 0.1"),
)


def panda() -> Robot:
    """Franka's arm of seven joints, with a workspace far from its limits and singularities."""
    home = dict(zip(PANDA, np.radians([0, -45, 0, -120, 0, 75, 45]), strict=True))
    sides = [0.2, 0.24, 0.2], np.radians([40, 40, 40])
    return load_robot("panda.urdf", "panda_link8", home, *sides)
