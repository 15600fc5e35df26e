"""Checks whether robots can have the study's damages and reach its workspaces.

They are separate from other checks because they load robots. They check only scenarios that run.
"""

from collections.abc import Iterable, Iterator
from functools import cache

import numpy as np

from recalib.damaged.damage import Damage, apply
from recalib.errors import InvalidFile, InvalidSetting, RecalibError, UnfitWorkspace, UnknownName
from recalib.files.quantities import LENGTH
from recalib.nominal.chain import TOLERANCE
from recalib.nominal.controller import Controller
from recalib.nominal.robots import Robot, link_end
from recalib.spelling import instead, listed
from replication.config.damages import describe
from replication.config.messages import KeyPath, Mistake, dotted, shown, unknown, unlike
from replication.config.study import Study
from replication.scenarios.assignments import Ways
from replication.scenarios.plants import nominal_of, nominal_robot
from replication.scenarios.resolving import has_part
from replication.training.plan import places


def check_robots(study: Study) -> list[Mistake]:
    """Mistakes that can only be found with the robots: in their settings and in their scenarios.

    The study must have passed `check`.
    """
    used = list(places(study))
    robots: dict[str, Robot] = {}
    mistakes: list[Mistake] = []
    for name, entry in study.robots.items():
        try:
            robots[name] = nominal_robot(nominal_of(study, name))
        except RecalibError as error:
            mistakes.append(_of_robot(name, error))
        else:
            mistakes += list(_of_slides(robots[name])) or _of_links(robots[name], entry.links)
    if mistakes:
        return mistakes
    for name in dict.fromkeys(robot for robot, _ in used):
        try:
            Controller(robots[name], study.controller.greatest_condition)
        except RecalibError as error:
            mistakes.append(_of_robot(name, error))
            continue
        for scenario in (scenario for robot, scenario in used if robot == name):
            mistakes += _of_scenario(study, scenario, robots[name])
    if not mistakes:
        assigned = dict.fromkeys(robot for robot, scenario in used if has_part(study, [scenario]))
        by_robot = (list(_of_assignment(robots[name], study)) for name in assigned)
        mistakes += next(filter(None, by_robot), [])  # other robots' mistakes would be the same
    if study.experiments.evidence and not mistakes:
        own = robots[study.robot]
        if len(own.joints) > 6:  # the posture is ambiguous, so there is no unique true mapping
            valid = f"false with the {own.name}, an arm of {len(own.joints)} joints"
            return [unlike(("experiments", "evidence"), True, valid)]
        mistakes += _of_ensemble(study, own)
    return mistakes


def _of_robot(name: str, error: RecalibError) -> Mistake:
    match error:
        case UnknownName():
            keys = ("tool", "home", "limits")
            key = next((key for key in keys if key in error.kind), None)
            if key:
                path = (key, error.name) if key in ("home", "limits") else (key,)
                return unknown(("robots", name, *path), error.name, error.valid)
            fault = f" is {shown(error.name)}, neither a file nor a URDF of example-robot-data"
            return Mistake(("robots", name, "urdf"), f"{fault}; {instead(error.name, error.valid)}")
        case InvalidFile():
            return unlike(("robots", name, "urdf"), error.path, "a file that is there")
        case InvalidSetting(key="home"):
            return Mistake(("robots", name, "home"), f" lacks joints; expected: {error.valid}")
        case InvalidSetting():
            return unlike(("robots", name, *error.key.split(".")), error.value, error.valid)
        case UnfitWorkspace():
            return Mistake(("robots", name, "workspace"), f" does not fit: {error}")
    return Mistake(("robots", name, "urdf"), f" does not fit: {error}")


def _refused(robot: Robot, damage: Damage) -> UnknownName | InvalidSetting | None:
    try:
        apply(robot, [damage])
    except (UnknownName, InvalidSetting) as error:
        return error
    return None


def _of_scenario(study: Study, scenario: str, robot: Robot) -> Iterator[Mistake]:
    """Links and joints that the robot does not have, amounts that are too large for it, and
    damages that together put even the middle of its workspace out of reach.
    """
    missing: dict[KeyPath, UnknownName] = {}
    damages: list[Damage] = []
    for index, entry in enumerate(study.scenarios[scenario]):
        if not isinstance(entry, Damage):
            continue
        path = "scenarios", scenario, index
        error, description = _refused(robot, entry), describe(entry)
        if isinstance(error, UnknownName):
            missing[(*path, next(iter(description)))] = error
            continue
        damages.append(entry)
        amount = next(key for key in entry.amounts() if key in description)
        if error:
            yield unlike((*path, amount), description[amount], error.valid)
            break
        if not _reaches_middle(robot, damages):
            where = f"the middle of the workspace within reach of the {robot.name}"
            yield unlike((*path, amount), description[amount], f"less, so that it leaves {where}")
            break
    if len(missing) > 1:  # the scenario is for another robot
        names = listed(dict.fromkeys(error.name for error in missing.values()), "and")
        has = f"has {listed(next(iter(missing.values())).valid, 'and')}"
        keys = ("scenario",), ("experiments", "scenarios")
        fault = f" is about {names}; the {robot.name} {has}"
        yield Mistake(("scenarios", scenario), fault, keys)
    else:
        yield from (unknown(where, error.name, error.valid) for where, error in missing.items())


def _reaches_middle(robot: Robot, damages: Iterable[Damage]) -> bool:
    """Whether a command takes the damaged robot to the middle of its workspace."""
    damaged, home = apply(robot, damages), robot.home[None]
    angles, errors = damaged.chain.solve(robot.arm.forward(home), home)
    within = (robot.lower <= angles) & (angles <= robot.upper)
    return bool(errors[0] <= TOLERANCE and within.all())


def _of_links(robot: Robot, links: Iterable[str]) -> Iterator[Mistake]:
    """Configured links that a robot does not have."""
    for index, link in enumerate(links):
        if link not in robot.links:
            yield unknown(("robots", robot.name, "links", index), link, robot.links)


def _of_slides(robot: Robot) -> Iterator[Mistake]:
    """Sliding joints: a study would treat their lengths as angles."""
    for joint, slides in zip(robot.joints, robot.arm.slides, strict=True):
        if slides:
            yield Mistake(
                ("robots", robot.name, "home", joint), " slides; expected: joints that turn"
            )


def _of_assignment(robot: Robot, study: Study) -> Iterator[Mistake]:
    """Too few links or joints of a robot, or links that are too short, for the paper's damage."""
    damage, links = study.paper_damage, study.robots[robot.name].links
    own, home = ("robots", robot.name, "links"), ("robots", robot.name, "home")
    for key, amounts, other, available in (
        ("shorten", damage.shorten, own, links),
        ("shift", damage.shift, home, robot.joints),
    ):
        if len(amounts) > len(available):
            valid = f"at most {len(available)}, one for each of {dotted(other)}"
            fault = f" is a list of {len(amounts)}; expected: {valid}"
            yield Mistake(("paper_damage", key), fault, (other,))
    arm, most = robot.arm, max(damage.shorten)
    ends = {link: link_end(arm, robot.links[link]) for link in links}
    lengths = {link: np.linalg.norm(end.translation) for link, end in ends.items()}
    short = [f"{link} {100 * length:.2f} cm" for link, length in lengths.items() if length <= most]
    if short:
        path = "paper_damage", "shorten", damage.shorten.index(most)
        valid = f"less than the lengths of links of the {robot.name}: {listed(short, 'and')}"
        yield unlike(path, LENGTH.write(most), valid, own)


def _of_ensemble(study: Study, robot: Robot) -> Iterator[Mistake]:
    """An ensemble with more robots than assignments for which the links are long enough."""
    damage, plan = study.paper_damage, study.experiments.ensemble
    ways = Ways(study.robots[robot.name].links, damage.shorten, robot.joints, damage.shift)
    refused = cache(lambda damage: _refused(robot, damage.scaled(max(plan.scales))))
    most = sum(not any(map(refused, short)) for short in ways.short) * len(ways.shifted)
    if plan.draws > most:
        valid = f"at most {most}, for which the links are long enough"
        yield unlike(("experiments", "ensemble", "draws"), plan.draws, valid)
