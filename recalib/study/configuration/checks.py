"""What types cannot say of a study: names that must exist, and what goes together.

What depends on a robot's geometry is in `recalib.study.configuration.robot_checks`.
"""

from collections.abc import Iterable, Iterator, Mapping

from recalib.damaged.kinds import DISTURBANCES
from recalib.errors import UnknownName
from recalib.study.configuration.damages import Assigned, describe
from recalib.study.configuration.messages import KeyPath, Mistake, unknown, unlike
from recalib.study.configuration.study import Study
from recalib.study.configuration.switches import IMPROVED, RITTER
from recalib.study.entrants import PEERS
from recalib.study.trainings import elsewhere, scenario_of, training


def check(study: Study) -> list[Mistake]:
    """The mistakes that can be seen without a robot; those of one kind hide those of the next."""
    for kind in (_names, _amounts, _evidence):
        if found := list(kind(study)):
            return found
    return []


def _places(path: KeyPath, names: Iterable[str]) -> dict[KeyPath, str]:
    """Where each name of a list, or each key of a mapping, stands."""
    by_key = isinstance(names, Mapping)
    return {(*path, name if by_key else index): name for index, name in enumerate(names)}


def _names(study: Study) -> Iterator[Mistake]:
    """Names that do not exist, or that mean two things."""
    plan, benchmark, real = study.experiments, study.benchmark, study.real
    known = list(study.every_learner)
    on_robots = [f"{name}-{robot}" for name in study.scenarios for robot in study.robots]
    for places, valid in (
        ({("robot",): study.robot, ("real", "robot"): real.robot}, study.robots),
        (_places(("experiments", "robots"), plan.robots), study.robots),
        (_places(("universes", "factors", "robot"), study.universes.factors.robot), study.robots),
        ({("scenario",): study.scenario}, study.scenarios),
        (_places(("experiments", "scenarios"), plan.scenarios), [*study.scenarios, *on_robots]),
        (_places(("benchmark", "scenarios"), benchmark.scenarios), [*study.scenarios, *on_robots]),
        (_places(("experiments", "ladder"), plan.ladder), known),
        (_places(("real", "learners"), real.learners), PEERS),
    ):
        for path, name in places.items():
            if name not in valid:
                yield unknown(path, name, valid)
    for places, peers in (
        (_places(("experiments", "learners"), plan.learners), ()),
        (_places(("experiments", "beside"), plan.beside), ()),
        (_places(("experiments", "ensemble"), plan.ensemble), ()),
        (_places(("benchmark", "learners"), benchmark.learners), PEERS),
        (_places(("real", "twin"), real.twin), ()),
    ):
        for path, name in places.items():
            if name not in peers and not _is_training(study, name):
                iterations = (f"{each}_ITERATIONS" for each in study.learners)
                yield unknown(path, name, [*peers, *known, *iterations])
    if plan.switches:
        for name in (IMPROVED, RITTER):
            if name not in study.learners:
                yield unlike(("experiments", "switches"), True, f"false without learners.{name}")
    for name in study.learners:
        stem, _, end = name.rpartition("_")
        if name in PEERS or (stem in study.learners and end.isdecimal()):
            yield Mistake(("learners", name), ": a name with another meaning; valid: a new one")


def _is_training(study: Study, name: str) -> bool:
    try:
        training(study, name)
    except UnknownName:
        return False
    return True


def _amounts(study: Study) -> Iterator[Mistake]:
    """More of something than there can be."""
    if study.robot in study.experiments.robots:
        path = "experiments", "robots", study.experiments.robots.index(study.robot)
        yield unlike(path, study.robot, "robots beside the study's own")
    for name, entries in study.scenarios.items():
        kinds = [type(entry) for entry in entries]
        for index, (entry, kind) in enumerate(zip(entries, kinds, strict=True)):
            if entry in entries[:index] or (kind in DISTURBANCES and kind in kinds[:index]):
                what = next(iter(describe(entry)))
                yield Mistake(("scenarios", name, index), f": {what} again; valid: once")
    robots = {name: study.robots[name] for name in assigned_robots(study)}
    links = {name: len(robot.links) for name, robot in robots.items()}
    joints = {name: len(robot.home) for name, robot in robots.items()}
    for key, places in (("shorten", links), ("shift", joints)):
        amounts = getattr(study.paper_damage, key)
        fewest = min(places, key=places.get, default=None)
        if fewest and len(amounts) > places[fewest]:
            fault = f" is a list of {len(amounts)}; valid: at most {places[fewest]} on the {fewest}"
            yield Mistake(("paper_damage", key), fault)


def used_scenarios(study: Study) -> list[tuple[str, str]]:
    """The scenarios that are trained on, each with its robot."""
    plan = study.experiments
    names = [*plan.scenarios, *elsewhere(study).values(), *study.benchmark.scenarios]
    return list(dict.fromkeys(scenario_of(study, name) for name in names))


def assigned_robots(study: Study) -> list[str]:
    """The robots to which the paper's damage is assigned."""
    assigned = (
        robot
        for scenario, robot in used_scenarios(study)
        if any(isinstance(entry, Assigned) for entry in study.scenarios[scenario])
    )
    return list(dict.fromkeys(assigned))


def _evidence(study: Study) -> Iterator[Mistake]:
    """What the claims need."""
    from recalib.study.evidence.claims import missing  # they know what a study is

    if not study.experiments.evidence:
        return
    when = "while experiments.evidence is true"
    if study.scenarios.get("intact"):
        yield Mistake(("scenarios", "intact"), f" is damaged; valid: an empty list {when}")
    for name in ("translation", "rotation", "translation_rotation", study.scenario):
        if not study.scenarios.get(name, True):
            yield Mistake(("scenarios", name), f" is an empty list; valid: damages {when}")
    if lacking := missing(study):
        with_ = "; ".join(lacking)
        yield unlike(("experiments", "evidence"), True, f"false, or true with {with_}")
