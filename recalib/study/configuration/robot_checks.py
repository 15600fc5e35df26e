"""Whether the robots of a study can have its damages and serve its workspaces.

This takes a second, since it loads them: apart from the other checks, so that its outcome may be
remembered.
"""

from collections.abc import Iterable, Iterator
from functools import cache

import numpy as np

from recalib.damaged.damage import Damage, apply
from recalib.damaged.words import words
from recalib.errors import InvalidSetting, RecalibError, UnfitWorkspace, UnknownName
from recalib.nominal.robots import Robot, link_end
from recalib.quantities import LENGTH
from recalib.study import jobs
from recalib.study.assignments import Ways
from recalib.study.configuration.checks import assigned_robots, used_scenarios
from recalib.study.configuration.damages import describe
from recalib.study.configuration.messages import Mistake, unknown, unlike
from recalib.study.configuration.study import Study
from recalib.study.plants import nominal_controller, nominal_robot


def check_robots(study: Study) -> list[Mistake]:
    """The mistakes that only the robots know of. The study must have passed `check`."""
    used = used_scenarios(study)
    working = {*(robot for _, robot in used), study.real.robot, *study.universes.factors.robot}
    robots: dict[str, Robot] = {}
    found: list[Mistake] = []
    for name, entry in study.robots.items():
        nominal = jobs.Nominal(name=name, robot=entry, controller=study.controller)
        try:
            robots[name] = _loaded(nominal.model_dump_json(), name in working)
        except RecalibError as error:
            found.append(_of_robot(name, error))
        else:
            found += _of_links(robots[name], entry.links)
            found += _of_slides(robots[name])
    if not found:
        for scenario, robot in used:
            found += _of_scenario(study, scenario, robots[robot])
        found += _of_assignment(study, [robots[name] for name in assigned_robots(study)])
        if study.experiments.evidence and not found:
            found += _of_mapping(robots[study.robot])
            found += _of_series(study, robots[study.robot])
    return found


@cache
def _loaded(nominal: str, works: bool) -> Robot:
    """The robot; if it works, once it is known that its controller serves its workspace."""
    job = jobs.Nominal.model_validate_json(nominal)
    return nominal_controller(job).robot if works else nominal_robot(job)


def _of_robot(name: str, error: RecalibError) -> Mistake:
    match error:
        case UnknownName():
            keys = ("tool", "home", "limits")
            key = next((key for key in keys if key in error.kind), "urdf")
            path = (key, error.name) if key in ("home", "limits") else (key,)
            return unknown(("robots", name, *path), error.name, error.valid)
        case InvalidSetting(key="home"):
            return Mistake(("robots", name, "home"), f" lacks joints; valid: {error.valid}")
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
    """Links and joints that the robot lacks, and amounts that are too much for it."""
    for index, entry in enumerate(study.scenarios[scenario]):
        if isinstance(entry, Damage) and (error := _refused(robot, entry)):
            keys = [word.key for word in words(type(entry)).values()]
            path = "scenarios", scenario, index
            if isinstance(error, UnknownName):
                yield unknown((*path, keys[0]), error.name, error.valid)
            else:
                yield unlike((*path, keys[1]), describe(entry)[keys[1]], error.valid)


def _of_links(robot: Robot, links: Iterable[str]) -> Iterator[Mistake]:
    """Links that a robot lacks."""
    for index, link in enumerate(links):
        if link not in robot.links:
            yield unknown(("robots", robot.name, "links", index), link, robot.links)


def _of_slides(robot: Robot) -> Iterator[Mistake]:
    """Joints that slide, of which a study would take an angle for a length."""
    for joint, slides in zip(robot.joints, robot.arm.slides, strict=True):
        if slides:
            yield Mistake(("robots", robot.name, "home", joint), " slides; valid: joints that turn")


def _of_assignment(study: Study, robots: Iterable[Robot]) -> Iterator[Mistake]:
    """Links that are too short for the paper's damage."""
    whole = {}
    for robot in robots:
        for link in study.robots[robot.name].links:
            end = link_end(robot.arm.model, robot.arm.tool, robot.links[link])
            whole[robot.name, link] = np.linalg.norm(end)
    name, link = min(whole, key=whole.get, default=(None, None))
    for index, length in enumerate(study.paper_damage.shorten):
        if whole and length >= whole[name, link]:
            valid = f"below {100 * whole[name, link]:.2f} cm, the length of {link} on the {name}"
            yield unlike(("paper_damage", "shorten", index), LENGTH.write(length), valid)


def _of_mapping(robot: Robot) -> Iterator[Mistake]:
    """An arm whose posture is the controller's choice: its true mapping is not known."""
    if len(robot.joints) > 6:
        valid = f"false with the {robot.name}, an arm of {len(robot.joints)} joints"
        yield unlike(("experiments", "evidence"), True, valid)


def _of_series(study: Study, robot: Robot) -> Iterator[Mistake]:
    """Series of more robots than there are assignments that leave something of every link."""
    damage, links = study.paper_damage, study.robots[robot.name].links
    ways = Ways(links, damage.shorten, robot.joints, damage.shift)
    refused = cache(lambda damage: _refused(robot, damage))
    for learner, series in study.experiments.ensemble.items():
        for name, its in series.items():
            scaled = ([each.scaled(max(its.scales)) for each in short] for short in ways.short)
            fit = sum(not any(map(refused, short)) for short in scaled)
            most = fit * len(ways.shifted)
            if its.draws > most:
                path = "experiments", "ensemble", learner, name, "draws"
                yield unlike(
                    path, its.draws, f"at most {most}, for which the links are long enough"
                )
