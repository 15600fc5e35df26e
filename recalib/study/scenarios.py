"""Scenarios: a robot, its controller and its damages, as the configuration describes them."""

from collections.abc import Mapping

from recalib.errors import UnknownName
from recalib.nominal.controller import Controller
from recalib.nominal.robots import Robot, load_robot
from recalib.quantities import ANGLE, LENGTH


def robot_of(scenario: str, config: Mapping) -> tuple[str, str]:
    """The scenario's entry in the configuration and its robot's: `NAME` is on the default robot, `NAME-ROBOT` on another.

    Raises UnknownName.
    """
    name, _, robot = scenario.partition("-")
    if name not in config["scenarios"]:
        raise UnknownName("scenario", name, config["scenarios"])
    robot = robot or config["robot"]
    if robot not in config["robots"]:
        raise UnknownName("robot", robot, config["robots"])
    return name, robot


def load_controller(robot: str, config: Mapping) -> Controller:
    """The nominal controller of a robot.

    Raises UnknownName (robot), and what `load_robot` and `Controller` raise.
    """
    if robot not in config["robots"]:
        raise UnknownName("robot", robot, config["robots"])
    return Controller(
        robot_of_entry(robot, config["robots"][robot]), config["controller"]["greatest_condition"]
    )


def robot_of_entry(name: str, entry: Mapping) -> Robot:
    """The robot that an entry of the configuration's `robots` describes; see `load_robot`."""
    workspace = entry["workspace"]
    return load_robot(
        entry["urdf"],
        entry["tool"],
        home={joint: ANGLE.read(angle) for joint, angle in entry["home"].items()},
        position_range=[LENGTH.read(side) for side in workspace["position"]],
        orientation_range=[ANGLE.read(side) for side in workspace["orientation"]],
        limits={
            joint: (ANGLE.read(low), ANGLE.read(high))
            for joint, (low, high) in entry.get("limits", {}).items()
        },
        name=name,
    )
