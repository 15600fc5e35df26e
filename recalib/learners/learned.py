"""Files of trained learners, to continue training or to correct commands of the same robot.

A file is an archive (`recalib.files.archives`). Its header has the format's version, the kind of
learner and its settings, and the robot. All other arrays are named RUN/GROUP/NAME.
"""

from collections.abc import Mapping
from os import PathLike
from typing import Any

import numpy as np

from recalib.errors import InvalidSetting, OtherRobot, check_kind
from recalib.files.archives import read_archive, refused, write_archive
from recalib.files.storage import path_of
from recalib.learners.kinds import class_of, kind_of
from recalib.loop.interfaces import Savable, State
from recalib.nominal.robots import Robot

FORMAT, VERSION = "recalib learner", 6
WRITER = "recalib.save"
ALIKE = 1e-9  # m, rad: smaller differences between two robots are ignored
PROBES = 8  # postures at which the kinematics of two robots are compared

Path = str | PathLike[str]


def save(path: Path, learner: Savable, robot: Robot) -> None:
    """Save a learner that was trained on a robot.

    Raises UnknownName (a learner of unknown kind) and InvalidSetting (`robot` is not a Robot).
    """
    check_kind("robot", robot, Robot)
    header = {
        "format": FORMAT,
        "version": VERSION,
        "kind": kind_of(learner),
        "settings": learner.settings(),
        "robot": identity(robot),
    }
    states = {str(run): state for run, state in enumerate(learner.state())}
    write_archive(path_of(path), header, states)


def load(path: Path, robot: Robot, run: int | None = None) -> Savable:
    """The learner that `save` wrote, for the same robot, with one run or (default) all runs.

    Raises InvalidFile (a damaged or missing file), OtherRobot, and InvalidSetting (no such run, or
    `robot` is not a Robot).
    """
    check_kind("robot", robot, Robot)
    header, states = read(path)
    with refused(path, WRITER):
        if found := differences(header["robot"], identity(robot)):
            raise OtherRobot(path, found)
        settings = header["settings"]
        if run is not None:
            if not 0 <= run < len(states):
                raise InvalidSetting("run", run, f"0 to {len(states) - 1}")
            states = [states[run]]
            if "by_run" in settings:
                settings["by_run"] = [settings["by_run"][run]]
        learner = class_of(header["kind"]).from_settings(settings, len(states), robot)
        learner.restore(states)
        centre = np.zeros((len(states), 1, 6))
        commands = learner.command(centre)
        if commands.shape != centre.shape or not np.isfinite(commands).all():
            raise ValueError
    return learner


def identity(robot: Robot) -> dict[str, Any]:
    """The properties that identify a robot, in the types of JSON: its motion, not its name."""
    joints = np.arange(len(robot.joints)) + 1
    angles = np.sin(np.outer(np.arange(PROBES) + 1, joints))  # rad, different for each joint
    numbers = {
        "kinematics": robot.arm.forward(angles),
        "home": robot.home,
        "workspace": robot.workspace.to_poses(1 - np.eye(6)),
    }
    names = {"joints": [*robot.joints], "tool": robot.arm.tool}
    return names | {name: value.ravel().tolist() for name, value in numbers.items()}


def differences(learned: Mapping[str, Any], here: Mapping[str, Any]) -> list[str]:
    """The differences between the identities of two robots, in words."""
    found = [
        f"its {name} {'are' if name == 'joints' else 'is'} {learned[name]}, not {here[name]}"
        for name in ("joints", "tool")
        if learned[name] != here[name]
    ]
    if learned["joints"] != here["joints"]:
        return found
    for name in ("kinematics", "home", "workspace"):
        gap = np.abs(np.subtract(learned[name], here[name])).max()
        if not gap <= ALIKE:
            found.append(f"its {name} differs by up to {gap:.3g} m or rad")
    return found


def read(path: Path) -> tuple[dict[str, Any], list[State]]:
    """Header and runs of a file. Raises InvalidFile if it is damaged or of another format."""
    header, groups = read_archive(path, (FORMAT, VERSION), WRITER)
    with refused(path, WRITER):
        return header, [groups[str(run)] for run in range(len(groups))]
