"""Which trainings a study consists of: what learners are called, and who is compared with whom."""

import re
from collections.abc import Iterable
from itertools import product
from typing import NamedTuple

from recalib.errors import UnknownName
from recalib.study.configuration.study import Budget, LearnerSettings, Measuring, Study
from recalib.study.configuration.switches import IMPROVED, RITTER, SWITCHES


class Training(NamedTuple):
    """A learner, and the number of iterations that it is tuned and trained for."""

    name: str
    iterations: int

    def __str__(self) -> str:
        return f"{self.name}_{self.iterations}"


def training(study: Study, learner: str) -> Training:
    """What `NAME` or `NAME_ITERATIONS` means. Raises UnknownName."""
    known = study.every_learner
    if learner in known:
        return Training(learner, known[learner].iterations)
    match = re.fullmatch(r"(\w+)_([1-9]\d{0,6})", learner)
    if match is None or match[1] not in known:
        raise UnknownName(
            "learner", learner, [*known, *(f"{name}_ITERATIONS" for name in study.learners)]
        )
    return Training(match[1], int(match[2]))


def rules(study: Study, learner: str) -> LearnerSettings:
    """A learner's settings, with the iterations that its name asks for. Raises UnknownName."""
    which = training(study, learner)
    return study.every_learner[which.name].model_copy(update={"iterations": which.iterations})


def rules_unless_peer(study: Study, learner: str) -> LearnerSettings | None:
    """A learner's settings; None for one of today's, which have none."""
    try:
        return rules(study, learner)
    except UnknownName:  # names were checked before
        return None


def searches(study: Study, learner: str) -> int:
    """How many independent searches there are for a learner."""
    short = training(study, learner).iterations <= study.search.short
    return study.search.searches if short else study.search.searches_long


def seeds(study: Study, learner: str) -> int:
    """How many seeds a learner is trained with, those of all its searches."""
    return searches(study, learner) * study.training.seeds


def budget(study: Study) -> Budget:
    """What a search may spend."""
    return Budget.model_construct(
        **{name: getattr(study.search, name) for name in Budget.model_fields}
    )


def measuring(study: Study) -> Measuring:
    """How trainings are measured."""
    return Measuring.model_construct(
        **{name: getattr(study.training, name) for name in Measuring.model_fields}
    )


def ritter_short(study: Study) -> str:
    """Ritter's learner trained for as long as the improved one."""
    return str(Training(RITTER, study.learners[IMPROVED].iterations))


def switched(study: Study) -> list[str]:
    """The learners that differ from the improved one, or from Ritter's, by one switch."""
    if not study.experiments.switches:
        return []
    return [*(switch.without for switch in SWITCHES), *(switch.added for switch in SWITCHES)]


def scenario_of(study: Study, scenario: str) -> tuple[str, str]:
    """Names of a scenario and its robot: `NAME` is on the study's robot, `NAME-ROBOT` on another.

    Raises UnknownName.
    """
    name, _, robot = scenario.partition("-")
    if name not in study.scenarios:
        raise UnknownName("scenario", name, study.scenarios)
    robot = robot or study.robot
    if robot not in study.robots:
        raise UnknownName("robot", robot, study.robots)
    return name, robot


def elsewhere(study: Study) -> dict[str, str]:
    """The study's own scenario on its robot and on the others: robot to scenario."""
    others = (robot for robot in study.experiments.robots if robot != study.robot)
    own = {study.robot: study.scenario}
    return own | {robot: f"{study.scenario}-{robot}" for robot in others}


class Trainings:
    """All trainings of a study, each a scenario and a learner: one name where two mean the same.

    Attributes:
        runs: (scenario, learner) of each training.
    """

    def __init__(self, study: Study):
        plan, own = study.experiments, study.scenario
        wanted = [
            *product(plan.scenarios, plan.learners),
            *product(list(elsewhere(study).values())[1:], plan.learners),
            *product([own], [*plan.beside, *switched(study)]),
            *((own, f"{name}_{rung}") for name, rungs in plan.ladder.items() for rung in rungs),
        ]
        self._study = study
        self._short: dict[Training, str] = {}
        for _, learner in wanted:
            self._short.setdefault(training(study, learner), learner)
        self.runs = list(
            dict.fromkeys((scenario, self.name(learner)) for scenario, learner in wanted)
        )

    def name(self, learner: str) -> str:
        """The name under which a training is done."""
        return self._short.get(training(self._study, learner), learner)

    def ladder(self, learner: str) -> dict[int, str]:
        """The trainings of a learner for several numbers of iterations, in ascending order."""
        rungs = sorted(self._study.experiments.ladder.get(learner, ()))
        return {rung: self.name(f"{learner}_{rung}") for rung in rungs}

    def scenarios(self) -> list[str]:
        """All scenarios of the study."""
        return list(dict.fromkeys(scenario for scenario, _ in self.runs))

    def tuned(self) -> list[str]:
        """All trainings that need settings, the longest first: no core waits for one at the end."""
        needed: Iterable[Training] = self._short
        return [str(each) for each in sorted(needed, key=lambda each: -each.iterations)]
