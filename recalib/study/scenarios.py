"""Scenarios: a robot, its controller and its damages, as the configuration describes them."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from recalib import quantities
from recalib.damaged.damage import BaseShift, Damage, EncoderShift, LinkShortening, apply
from recalib.damaged.disturbances import Disturbances
from recalib.damaged.nongeometric import Backlash, EccentricGear, Sag
from recalib.errors import InvalidSetting, UnknownName
from recalib.nominal.controller import Controller
from recalib.nominal.robots import Robot, load_robot

DAMAGES = (
    "link + shorten",
    "encoder + shift",
    "translate",
    "rotate",
    "gear + eccentricity + phase",
    "sag + compliance",
    "backlash + gap",
)
DISTURBANCES = (
    "noise",
    "repeatability",
    "outliers",
)  # entries that disturb moves and measurements, not the arm
ASSIGNED = {
    "links": "link",
    "encoders": "encoder",
}  # which entries of the paper's damage each word stands for


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
        home={joint: quantities.angle(angle) for joint, angle in entry["home"].items()},
        position_range=[quantities.length(side) for side in workspace["position"]],
        orientation_range=[quantities.angle(side) for side in workspace["orientation"]],
        limits={
            joint: (quantities.angle(low), quantities.angle(high))
            for joint, (low, high) in entry.get("limits", {}).items()
        },
        name=name,
    )


def is_assigned(entries: Iterable[Mapping]) -> bool:
    """Whether any of the damages is part of the paper's damage, as assigned to the robot."""
    return any("assigned" in entry for entry in entries)


def resolve(entries: Iterable[Mapping], assignment: Sequence[Mapping]) -> list[Mapping]:
    """The scenario's damages with `assigned: ...` replaced by the entries of the assignment, in the same words."""
    resolved: list[Mapping] = []
    for entry in entries:
        if "assigned" in entry:
            resolved += [part for part in assignment if ASSIGNED[entry["assigned"]] in part]
        else:
            resolved.append(entry)
    return resolved


def parse_damage(entry: Mapping[str, Any]) -> Damage:
    """The damage that an entry such as {link: forearm_link, shorten: 4 cm} describes. Raises InvalidQuantity."""
    match entry:
        case {"link": link, "shorten": amount}:
            return LinkShortening(link, quantities.length(amount))
        case {"encoder": joint, "shift": amount}:
            return EncoderShift(joint, quantities.angle(amount))
        case {"translate": amounts}:
            return BaseShift(translation=tuple(map(quantities.length, amounts)))
        case {"rotate": amounts}:
            return BaseShift(rotation=tuple(map(quantities.angle, amounts)))
        case {"gear": joint, "eccentricity": amount, "phase": phase}:
            return EccentricGear(joint, quantities.angle(amount), quantities.angle(phase))
        case {"sag": joint, "compliance": amount}:
            return Sag(joint, quantities.compliance(amount))
        case {"backlash": joint, "gap": amount}:
            return Backlash(joint, quantities.angle(amount))
    raise UnknownName("damage", str(dict(entry)), DAMAGES)


def parse_damages(entries: Iterable[Mapping]) -> list[Damage]:
    """The damages among resolved entries of a scenario."""
    return [parse_damage(entry) for entry in entries if not entry.keys() & set(DISTURBANCES)]


def parse_disturbances(entries: Iterable[Mapping]) -> Disturbances | None:
    """What disturbs moves and measurements, among the entries of a scenario, if anything. Raises InvalidQuantity."""
    amounts: dict[str, float] = {}
    for entry in entries:
        match entry:
            case {"noise": {"position": position, "orientation": orientation}}:
                amounts |= {
                    "position_noise": quantities.length(position),
                    "orientation_noise": quantities.angle(orientation),
                }
            case {"repeatability": amount}:
                amounts["repeatability"] = quantities.angle(amount)
            case {"outliers": {"share": share, "size": size}}:
                amounts |= {"outlier_fraction": share, "outlier_size": quantities.length(size)}
    return Disturbances(**amounts) if amounts else None


def describe_damage(damage: LinkShortening | EncoderShift) -> dict[str, str]:
    """The entry that `parse_damage` reads as this damage."""
    if isinstance(damage, LinkShortening):
        return {"link": damage.link, "shorten": f"{damage.length * 100:.6g} cm"}
    return {"encoder": damage.joint, "shift": f"{quantities.degrees(damage.angle):.6g} deg"}


def check(config: Mapping) -> None:
    """Raise an error of this library for the first name or amount in the configuration that its robots cannot have.

    Everything that needs no training: the workspace of every robot of the default run, the paper's damage on it, and the
    damages of every scenario, those of the benchmark included.
    """
    experiments = config["experiments"]
    for name in [config["robot"], *experiments["robots"]]:
        if name not in config["robots"]:
            raise UnknownName("robot", name, config["robots"])
        _check_paper_damage(load_controller(name, config).robot, config)
    robots = {}
    for scenario in dict.fromkeys([*experiments["scenarios"], *config["benchmark"]["scenarios"]]):
        name, robot = robot_of(scenario, config)
        if robot not in robots:
            robots[robot] = robot_of_entry(robot, config["robots"][robot])
        explicit = [entry for entry in config["scenarios"][name] if "assigned" not in entry]
        apply(robots[robot], parse_damages(explicit))
        parse_disturbances(explicit)
    for key, (low, high) in config["search"]["ranges"].items():
        if low > high:
            raise InvalidSetting(f"search.ranges.{key}", [low, high], "the lower value first")


def _check_paper_damage(robot: Robot, config: Mapping) -> None:
    paper, links = config["paper_damage"], config["robots"][robot.name]["links"]
    for key, places in (("shorten", links), ("shift", robot.joints)):
        if len(paper[key]) > len(places):
            raise InvalidSetting(
                f"paper_damage.{key}", paper[key], f"at most {len(places)} on the {robot.name}"
            )
    for link in links:
        for amount in paper["shorten"]:
            apply(robot, [LinkShortening(link, quantities.length(amount))])
    for amount in paper["shift"]:
        quantities.angle(amount)
