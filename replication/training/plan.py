"""The trainings of a study, and the files of their results."""

from typing import NamedTuple

from replication.config.study import Study
from replication.config.switches import IMPROVED, SWITCHES


class Place(NamedTuple):
    """A robot in a scenario."""

    robot: str
    scenario: str

    def scenario_file(self, root: str) -> str:
        """The file of the resolved scenario, in a folder of results."""
        return f"{root}/robots/{self.robot}/{self.scenario}.json"

    def history_file(self, root: str, learner: str) -> str:
        """The file with the histories of all trainings of a learner in this place."""
        return f"{root}/runs/{self.robot}/{self.scenario}/{learner}.parquet"

    def learned_file(self, root: str, learner: str) -> str:
        """The file with the learned state of a learner in this place."""
        return f"{root}/runs/{self.robot}/{self.scenario}/{learner}.npz"


Lengths = dict[str, tuple[int, ...]]  # by learner, ascending


def places(study: Study) -> dict[Place, Lengths]:
    """The learners and their numbers of iterations, by robot and scenario."""
    plan, main = study.experiments, Place(study.robot, study.scenario)
    planned = {Place(study.robot, scenario): dict(plan.learners) for scenario in plan.scenarios}
    planned |= {Place(robot, study.scenario): dict(plan.learners) for robot in plan.robots}
    own_learners = planned.setdefault(main, {})
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
    """Whether figures show the course of a training, not only its beginning and end."""
    return iterations in study.experiments.learners.get(learner, ()) and place.robot == study.robot


class Run(NamedTuple):
    """A training of a learner in a scenario of the study's robot."""

    learner: str
    iterations: int
    scenario: str


def leading(study: Study) -> Run:
    """The training of Figure 1: the improved system or, if a study has none, the first learner."""
    plan = study.experiments
    learner = IMPROVED if IMPROVED in plan.learners else next(iter(plan.learners))
    lengths = plan.learners[learner]
    iterations = plan.iterations if plan.iterations in lengths else min(lengths)
    scenario = study.scenario if study.scenario in plan.scenarios else plan.scenarios[0]
    return Run(learner, iterations, scenario)
