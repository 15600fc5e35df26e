"""Which trainings a study consists of, and where their results lie."""

from typing import NamedTuple

from replication.config.study import Study
from replication.config.switches import IMPROVED, SWITCHES


class Place(NamedTuple):
    """A robot in a scenario."""

    robot: str
    scenario: str

    def scenario_file(self, root: str) -> str:
        """The scenario as resolved, below a folder of results."""
        return f"{root}/robots/{self.robot}/{self.scenario}.json"

    def history_file(self, root: str, learner: str) -> str:
        """The history of all trainings of a learner here."""
        return f"{root}/runs/{self.robot}/{self.scenario}/{learner}.parquet"

    def learned_file(self, root: str, learner: str) -> str:
        """What they learned."""
        return f"{root}/runs/{self.robot}/{self.scenario}/{learner}.npz"


Lengths = dict[str, tuple[int, ...]]  # by learner, ascending


def places(study: Study) -> dict[Place, Lengths]:
    """For how many iterations which learners are trained, by robot and scenario."""
    plan, own = study.experiments, Place(study.robot, study.scenario)
    planned = {Place(study.robot, scenario): dict(plan.learners) for scenario in plan.scenarios}
    planned |= {Place(robot, study.scenario): dict(plan.learners) for robot in plan.robots}
    own_learners = planned.setdefault(own, {})
    more = [*plan.own.items()]
    if plan.switches:
        names = (name for switch in SWITCHES for name in (switch.without, switch.added))
        more += [(name, (plan.iterations,)) for name in names]
    for name, lengths in more:
        if lengths:
            own_learners[name] = (*own_learners.get(name, ()), *lengths)
    return {
        place: {name: tuple(sorted({*iterations})) for name, iterations in lengths.items()}
        for place, lengths in planned.items()
    }


def throughout(study: Study, place: Place, learner: str, iterations: int) -> bool:
    """Whether figures show how a training went on its way."""
    return iterations in study.experiments.learners.get(learner, ()) and place.robot == study.robot


class Run(NamedTuple):
    """A learner in a scenario of the study's robot, trained for so many iterations."""

    learner: str
    iterations: int
    scenario: str


def leading(study: Study) -> Run:
    """The training of Figure 1: of the improved system, or of the first learner without it."""
    plan = study.experiments
    learner = IMPROVED if IMPROVED in plan.learners else next(iter(plan.learners))
    lengths = plan.learners[learner]
    iterations = plan.iterations if plan.iterations in lengths else min(lengths)
    scenario = study.scenario if study.scenario in plan.scenarios else plan.scenarios[0]
    return Run(learner, iterations, scenario)
