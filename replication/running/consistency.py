"""Consistency checks of a study: names must exist, and keys must agree.

Checks that depend on a robot's geometry are in `replication.running.geometry`.
"""

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import fields
from typing import Any

import numpy as np

from recalib.damaged.damage import BaseShift, Damage
from recalib.spelling import listed
from replication.config.damages import Assigned, Entry, describe
from replication.config.messages import KeyPath, Mistake, shown, unknown, unlike
from replication.config.study import Study
from replication.config.switches import IMPROVED, RITTER, SWITCHES
from replication.training.competitors import MOVES, peers
from replication.training.measured import RIGID

MOST_CELLS = 1_000_000  # in a map; a training has many maps, and a cell has 42 numbers


def check(study: Study) -> list[Mistake]:
    """Mistakes that can be found without a robot, of the first kind of which there are any."""
    for kind in (_names, _meanings, _amounts, _evidence):
        if found := list(kind(study)):
            return found
    return []


def unused(inherited: Iterable[str], study: Study) -> Iterator[Mistake]:
    """Scenarios that a study adds to the inherited ones, but that nothing uses or shows."""
    shown, compared = {*study.experiments.scenarios}, {*study.benchmark.scenarios}
    for name in study.scenarios:
        if name in shown or name in inherited:
            continue
        if name == study.scenario:  # learners train on it, but no figure shows it
            valid = f"one of experiments.scenarios, which are {listed(sorted(shown), 'and')}"
            yield unlike(("scenario",), name, valid, ("experiments", "scenarios"))
        elif name not in compared:
            valid = "scenario, experiments.scenarios or benchmark.scenarios to name it"
            yield Mistake(("scenarios", name), f": nothing uses it; expected: {valid}")


def _places(path: KeyPath, names: Iterable[Any]) -> dict[KeyPath, Any]:
    """The names in a list, or the keys of a mapping, by their paths."""
    by_key = isinstance(names, Mapping)
    return {(*path, str(name) if by_key else index): name for index, name in enumerate(names)}


def _names(study: Study) -> Iterator[Mistake]:
    """Unknown names, and names that already have another meaning."""
    if study.robot not in study.robots:
        yield unknown(("robot",), study.robot, study.robots)
        return  # learners depend on its workspace
    plan, benchmark, real = study.experiments, study.benchmark, study.real
    papers = list(study.every_learner)
    references: tuple[tuple[dict[KeyPath, str], Iterable[str]], ...] = (
        ({("real", "robot"): real.robot}, study.robots),
        (_places(("experiments", "robots"), plan.robots), study.robots),
        (_places(("campaign", "factors", "robot"), study.campaign.factors.robot), study.robots),
        ({("scenario",): study.scenario}, study.scenarios),
        (_places(("experiments", "scenarios"), plan.scenarios), study.scenarios),
        (_places(("benchmark", "scenarios"), benchmark.scenarios), study.scenarios),
        (_places(("experiments", "learners"), plan.learners), papers),
        (_places(("experiments", "own"), plan.own), papers),
        (_places(("benchmark", "papers"), benchmark.papers), papers),
        (_places(("benchmark", "learners"), benchmark.learners), peers()),
        (_places(("real", "twin"), real.twin), papers),
        (_places(("real", "learners"), real.learners), peers()),
    )
    for places, valid in references:
        for path, name in places.items():
            if name not in valid:
                yield unknown(path, name, valid)
    if plan.switches:
        for name in (IMPROVED, RITTER):
            if name not in study.learners:
                yield unlike(("experiments", "switches"), True, f"false without learners.{name}")
    taken = {*peers(), *(name for switch in SWITCHES for name in (switch.without, switch.added))}
    for name in taken.intersection(study.learners):
        yield Mistake(("learners", name), ": this name has another meaning; try: another name")


def _meanings(study: Study) -> Iterator[Mistake]:
    """Scenarios and learners that contradict their names or roles."""
    if not any(map(_damages, study.scenarios[study.scenario])):
        valid = "a scenario with damage: an intact robot leaves nothing to learn"
        yield unlike(("scenario",), study.scenario, valid)
    if study.experiments.switches:
        for switch in SWITCHES:
            for name, valid in ((IMPROVED, switch.improved), (RITTER, switch.ritter)):
                value = getattr(study.learners[name], switch.key)
                if value != valid:
                    condition = "while experiments.switches is true"
                    yield unlike(("learners", name, switch.key), value, f"{valid} {condition}")


def _amounts(study: Study) -> Iterator[Mistake]:
    """Amounts that are too large or too small, and duplicates."""
    yield from _budgets(study)
    if study.experiments.evidence:  # scales are only used for evidence
        yield from _scales(study)
    for name, learner in study.learners.items():
        if math.prod((*learner.supernet, *learner.subnet)) > MOST_CELLS:
            valid = f"at most {MOST_CELLS:,} cells, including those of subnets"
            subnet = "learners", name, "subnet"
            yield unlike(("learners", name, "supernet"), learner.supernet, valid, subnet)
    for name, entries in study.scenarios.items():
        subjects = list(map(_subject, entries))
        for index, (entry, subject) in enumerate(zip(entries, subjects, strict=True)):
            if subject in subjects[:index]:
                fault = f" is {shown(describe(entry))} again; expected: once"
                yield Mistake(("scenarios", name, index), fault)


def _budgets(study: Study) -> Iterator[Mistake]:
    """Numbers of moves after which a learner cannot be measured."""
    plan = study.benchmark
    for place, moves in _places(("benchmark", "longer"), plan.longer).items():
        if moves in plan.moves:
            yield unlike(place, moves, "a budget that is not among benchmark.moves")
    for name, iterations in plan.papers.items():
        most = MOVES * iterations
        if not any(
            budget <= most and budget % MOVES == 0 for budget in (*plan.moves, *plan.longer)
        ):
            valid = f"a list with an even number up to {most}, to measure {name} at least once"
            yield unlike(("benchmark", "moves"), plan.moves, valid)


def _scales(study: Study) -> Iterator[Mistake]:
    """Scales of damages that would shift an encoder by more than half a turn."""
    most = math.pi / max(study.paper_damage.shift)
    places = _places(("mapping", "scales"), study.mapping.scales)
    places |= _places(("experiments", "ensemble", "scales"), study.experiments.ensemble.scales)
    for place, scale in places.items():
        if scale > most * (1 + 1e-9):
            yield unlike(place, scale, f"up to {most:.4g}, where an encoder is off by 180 deg")


def _subject(entry: Entry) -> object:
    """The subject of an entry, without amounts, to find duplicates; base shifts may repeat."""
    if isinstance(entry, BaseShift):
        return entry
    names = [field.name for field in fields(entry) if field.name not in entry.amounts()]
    return type(entry), *(getattr(entry, name) for name in names)


def _damages(entry: Entry) -> bool:
    """Whether an entry changes the robot."""
    if not isinstance(entry, Damage):
        return isinstance(entry, Assigned)
    return any(np.any(getattr(entry, name)) for name in entry.amounts())


def _evidence(study: Study) -> Iterator[Mistake]:
    """Scenarios that contradict their names, on which claims rely."""
    if not study.experiments.evidence:
        return
    condition = "while experiments.evidence is true"
    if study.scenarios.get("intact"):
        yield Mistake(("scenarios", "intact"), f" is damaged; expected: an empty list {condition}")
    for name in RIGID:
        entries = study.scenarios.get(name, ())
        if name in study.scenarios and not any(map(_damages, entries)):
            problem = "moves nothing" if entries else "is an empty list"
            yield Mistake(("scenarios", name), f" {problem}; expected: damages {condition}")
    damages = study.scenarios[study.scenario]
    for part in ("links", "encoders"):
        if Assigned(assigned=part) not in damages:
            fault = f" has no assigned: {part}; expected: the paper's damage {condition}"
            yield Mistake(("scenarios", study.scenario), fault)
