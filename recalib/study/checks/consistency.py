"""Consistency of a study: names that must exist, and keys that go together.

What depends on a robot's geometry is in `recalib.study.checks.geometry`.
"""

import math
from collections.abc import Iterable, Iterator, Mapping
from functools import partial
from typing import TypeVar

import numpy as np

from recalib.damaged.damage import BaseShift, Damage
from recalib.damaged.kinds import DISTURBANCES
from recalib.damaged.words import words
from recalib.spelling import instead, listed
from recalib.study.configuration.damages import Assigned, Entry, describe
from recalib.study.configuration.messages import KeyPath, Mistake, dotted, shown, unknown, unlike
from recalib.study.configuration.study import Study
from recalib.study.configuration.switches import IMPROVED, RITTER, SWITCHES
from recalib.study.evidence.claims import missing
from recalib.study.inference.measured import MOVED, RIGID
from recalib.study.plan.competitors import MOVES, peers
from recalib.study.plan.trainings import rules_unless_peer, scenario_of, training

Each = TypeVar("Each")
MOST_CELLS = 1_000_000  # of a map; each training has many maps, and a cell 42 numbers


def check(study: Study) -> list[Mistake]:
    """The mistakes that can be seen without a robot; those of one kind hide those of the next."""
    for kind in (_names, _meanings, _amounts, _evidence):
        if found := list(kind(study)):
            return found
    return []


def unused(inherited: Iterable[str], study: Study) -> Iterator[Mistake]:
    """Scenarios that a study adds to those inherited, and that nothing, or half of it, uses."""
    shown, compared = (
        {name.partition("-")[0] for name in plan.scenarios}
        for plan in (study.experiments, study.benchmark)
    )
    for name in study.scenarios:
        if name in shown or name in inherited:
            continue
        if name == study.scenario:  # learners are trained on it, but no figure shows it
            valid = f"one of experiments.scenarios, which are {listed(sorted(shown), 'and')}"
            yield unlike(("scenario",), name, valid, ("experiments", "scenarios"))
        elif name not in compared:
            valid = "scenario, experiments.scenarios or benchmark.scenarios to name it"
            yield Mistake(("scenarios", name), f": nothing uses it; expected: {valid}")


def _places(path: KeyPath, names: Iterable[Each]) -> dict[KeyPath, Each]:
    """Where each name of a list, or each key of a mapping, stands."""
    by_key = isinstance(names, Mapping)
    return {(*path, str(name) if by_key else index): name for index, name in enumerate(names)}


def _names(study: Study) -> Iterator[Mistake]:
    """Names that do not exist, or that mean two things."""
    plan, benchmark, real = study.experiments, study.benchmark, study.real
    known = list(study.every_learner)
    found: tuple[tuple[dict[KeyPath, str], Iterable[str]], ...] = (
        ({("robot",): study.robot, ("real", "robot"): real.robot}, study.robots),
        (_places(("experiments", "robots"), plan.robots), study.robots),
        (_places(("universes", "factors", "robot"), study.universes.factors.robot), study.robots),
        ({("scenario",): study.scenario}, study.scenarios),
        (_places(("experiments", "ladder"), plan.ladder), known),
        (_places(("real", "learners"), real.learners), peers()),
    )
    for places, valid in found:
        for path, name in places.items():
            if name not in valid:
                yield unknown(path, name, valid)
    for part, of in (("experiments", plan), ("benchmark", benchmark)):
        for path, whole in _places((part, "scenarios"), of.scenarios).items():
            name, on, robot = whole.partition("-")
            if name not in study.scenarios:
                yield unknown(path, whole, study.scenarios)
            elif on and robot not in study.robots:
                valid = instead(robot, study.robots)
                yield Mistake(path, f" is {shown(whole)}, on an unknown robot; {valid}")
    for places, todays in (
        (_places(("experiments", "learners"), plan.learners), ()),
        (_places(("experiments", "beside"), plan.beside), ()),
        (_places(("experiments", "ensemble"), plan.ensemble), ()),
        (_places(("benchmark", "learners"), benchmark.learners), peers()),
        (_places(("real", "twin"), real.twin), ()),
    ):
        for path, name in places.items():
            if name not in todays and rules_unless_peer(study, name) is None:
                iterations = (f"{stem}_ITERATIONS" for stem in study.learners)
                yield unknown(path, name, [*todays, *known, *iterations])
    if plan.switches:
        for name in (IMPROVED, RITTER):
            if name not in study.learners:
                yield unlike(("experiments", "switches"), True, f"false without learners.{name}")
    taken = {*peers(), *(name for switch in SWITCHES for name in (switch.without, switch.added))}
    for name in study.learners:
        stem, _, end = name.rpartition("_")
        if name in taken or (stem in study.learners and end.isdecimal()):
            yield Mistake(("learners", name), ": a name with another meaning; try: a new one")


def _meanings(study: Study) -> Iterator[Mistake]:
    """What would not be what it is called, or be there twice under two names."""
    plan, benchmark = study.experiments, study.benchmark

    def learner(name: str) -> tuple:
        return (name,) if name in peers() else training(study, name)

    for path, names, meaning in (
        (("experiments", "learners"), plan.learners, learner),
        (("experiments", "beside"), plan.beside, learner),
        (("benchmark", "learners"), benchmark.learners, learner),
        (("real", "twin"), study.real.twin, learner),
        (("experiments", "scenarios"), plan.scenarios, partial(scenario_of, study)),
        (("benchmark", "scenarios"), benchmark.scenarios, partial(scenario_of, study)),
    ):
        first: dict[tuple, str] = {}
        for place, name in _places(path, names).items():
            if (other := first.setdefault(meaning(name), name)) != name:
                yield unlike(place, name, f"another than {other}, which it is")
    if not any(map(_damages, study.scenarios[study.scenario])):
        valid = "a scenario with a damage: of an intact robot nothing is learned"
        yield unlike(("scenario",), study.scenario, valid)
    if plan.switches:
        for switch in SWITCHES:
            for name, valid in ((IMPROVED, switch.improved), (RITTER, switch.ritter)):
                stood = getattr(study.learners[name], switch.key)
                if stood != valid:
                    when = "while experiments.switches is true"
                    yield unlike(("learners", name, switch.key), stood, f"{valid} {when}")
    path = "scenarios", MOVED
    if [type(entry) for entry in study.scenarios.get(MOVED, ())] != [BaseShift, BaseShift]:
        yield Mistake(
            path, " is something else; expected: translate, then rotate, for the universes"
        )
    yield from _rungs(study)


def _rungs(study: Study) -> Iterator[Mistake]:
    """Rungs of the universes between which no factor can lie, or none that the claim is about."""
    from recalib.study.evidence.claims.speed_up import LONG  # it knows what a study is

    path, rungs = ("universes", "rungs"), study.universes.rungs
    if study.experiments.evidence and study.universes.count & (study.universes.count - 1):
        yield unlike(("universes", "count"), study.universes.count, "a power of two, for balance")
    if len(rungs) < 2:
        yield unlike(path, rungs, "two or more, between which the factor is sought")
    elif list(rungs) != sorted(rungs):
        yield unlike(path, rungs, "the lowest first")
    elif IMPROVED in study.learners:
        iterations, own = ("learners", IMPROVED, "iterations"), study.learners[IMPROVED].iterations
        judged = study.experiments.evidence
        times = int(LONG) if judged else 1
        if rungs[-1] <= times * own:
            valid = f"one above {times * own}, for factors above {times} over {dotted(iterations)}"
            yield unlike(path, rungs, valid, iterations)
        elif judged and rungs[0] >= times * own:
            valid = f"one below {times * own}, for factors below {times} over {dotted(iterations)}"
            yield unlike(path, rungs, valid, iterations)


def _amounts(study: Study) -> Iterator[Mistake]:
    """More of something than there can be, or less than it takes."""
    yield from _budgets(study)
    if study.experiments.evidence:  # nothing else is scaled
        yield from _scales(study)
    for name, learner in study.learners.items():
        if math.prod((*learner.supernet, *learner.subnet)) > MOST_CELLS:
            valid = f"at most {MOST_CELLS:,} cells, with those of the subnet"
            subnet = "learners", name, "subnet"
            yield unlike(("learners", name, "supernet"), learner.supernet, valid, subnet)
    for name, entries in study.scenarios.items():
        subjects = list(map(_subject, entries))
        for index, (entry, subject) in enumerate(zip(entries, subjects, strict=True)):
            if subject in subjects[:index]:
                (key, value), *_ = describe(entry).items()
                what = f"{key} {value}" if isinstance(value, str) else key
                yield Mistake(("scenarios", name, index), f": {what} again; expected: once")


def _budgets(study: Study) -> Iterator[Mistake]:
    """Budgets of moves at which a learner cannot be measured."""
    plan = study.benchmark
    for place, moves in _places(("benchmark", "longer"), plan.longer).items():
        if moves in plan.moves:
            yield unlike(place, moves, "a budget that is not among benchmark.moves")
    for name in plan.learners:
        most = 0 if name in peers() else MOVES * training(study, name).iterations
        if most and not any(
            budget <= most and budget % MOVES == 0 for budget in (*plan.moves, *plan.longer)
        ):
            valid = f"a list with an even number up to {most}, after which {name} can be measured"
            yield unlike(("benchmark", "moves"), plan.moves, valid)


def _scales(study: Study) -> Iterator[Mistake]:
    """Damages that turn an encoder by more than there is."""
    most = math.pi / max(study.paper_damage.shift)
    places = _places(("mapping", "scales"), study.mapping.scales)
    for learner, series in study.experiments.ensemble.items():
        for name, its in series.items():
            places |= _places(("experiments", "ensemble", learner, name, "scales"), its.scales)
    for place, scale in places.items():
        if scale > most * (1 + 1e-9):
            yield unlike(place, scale, f"up to {most:.4g}, where an encoder is off by 180 deg")


def _subject(entry: Entry) -> object:
    """What an entry is about, without by how much; the robot may be moved again and again."""
    if isinstance(entry, Assigned | BaseShift):
        return entry
    if isinstance(entry, DISTURBANCES):
        return type(entry)
    said = words(type(entry)).items()
    return type(entry), *(getattr(entry, name) for name, word in said if not word.grows)


def _damages(entry: Entry) -> bool:
    """Whether the robot differs by it."""
    if not isinstance(entry, Damage):
        return isinstance(entry, Assigned)
    said = words(type(entry)).items()
    return any(np.any(getattr(entry, name)) for name, word in said if word.grows)


def _evidence(study: Study) -> Iterator[Mistake]:
    """What the claims need."""
    if not study.experiments.evidence:
        return
    when = "while experiments.evidence is true"
    if study.scenarios.get("intact"):
        yield Mistake(("scenarios", "intact"), f" is damaged; expected: an empty list {when}")
    for name in RIGID:
        entries = study.scenarios.get(name)  # what is missing is told below
        if entries is not None and not any(map(_damages, entries)):
            what = "moves nothing" if entries else "is an empty list"
            yield Mistake(("scenarios", name), f" {what}; expected: damages {when}")
    own = study.scenarios[study.scenario]
    for part in ("links", "encoders"):
        if Assigned(assigned=part) not in own:
            fault = f" has no assigned: {part}; expected: the paper's damage {when}"
            yield Mistake(("scenarios", study.scenario), fault)
    if lacking := missing(study):
        with_ = "; ".join(lacking)
        yield unlike(("experiments", "evidence"), True, f"false, or true with {with_}")
