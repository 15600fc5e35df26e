"""What a claim, a figure or a page reads: asked for once, and the rule's inputs and arguments.

What was asked for is an `Evidence`, and nothing else can be read from it. Asking loads no tables
and draws nothing, since the workflow does it whenever it starts.
"""

from collections.abc import Callable, Mapping
from itertools import takewhile
from pathlib import Path

from pydantic import JsonValue

from recalib.errors import UnknownName
from recalib.study.configuration.damages import Assigned
from recalib.study.configuration.study import Study
from recalib.study.configuration.switches import IMPROVED, RITTER
from recalib.study.evidence.results import Evidence
from recalib.study.recordings import recordings
from recalib.study.shipped import DESIGN, RESULTS, SHIPPED, pieces
from recalib.study.trainings import Trainings, elsewhere, ritter_short, training

# Ritter's net with as many cells as both maps: where it is trained, it leads
DOUBLE = "ritter_double"

# Measured for a study with evidence alone
OF_EVIDENCE = "ensemble/", "mapping/"

# What may be known of a study beside its results. Trainings go by their role in the paper.
FACTS: Mapping[str, Callable[[Study, Trainings], JsonValue]] = {
    "shipped": lambda study, _: study.name == SHIPPED,
    "seed": lambda study, _: study.seed,
    "robot": lambda study, _: study.robot,
    "scenario": lambda study, _: study.scenario,
    "scenarios": lambda study, _: list(study.experiments.scenarios),
    "recordings": lambda study, _: recordings(study),
    "elsewhere": lambda study, _: elsewhere(study),
    "published": lambda study, _: study.paper_damage.published.model_dump(),
    "published_mm": lambda study, _: study.real.published.model_dump(),
    "iterations": lambda study, _: study.learners[IMPROVED].iterations,
    "improved": lambda _, trainings: trainings.name(IMPROVED),
    "ritter": lambda _, trainings: trainings.name(RITTER),
    "short": lambda study, trainings: trainings.name(ritter_short(study)),
    "compared": lambda study, trainings: [
        trainings.name(each)
        for each in (DOUBLE if DOUBLE in study.experiments.beside else RITTER, IMPROVED)
        if each in (*study.experiments.learners, *study.experiments.beside)
    ],
    "learners": lambda study, trainings: [
        trainings.name(each) for each in study.experiments.learners
    ],
    "beside": lambda study, _: [
        each
        for each in study.experiments.beside
        if training(study, each).iterations == study.learners[IMPROVED].iterations
    ],
    "switches": lambda study, _: study.experiments.switches,
    "ladder": lambda study, trainings: {
        each: list(map(list, trainings.ladder(each).items())) for each in study.experiments.ladder
    },
    "setups": lambda study, _: {
        "outcomes": study.universes.count,
        "horizon": len(study.universes.horizons),
    },
    "rough_trials": lambda study, _: study.universes.rough_trials,
    "coupling_poses": lambda study, _: study.mapping.poses,
    "balls": lambda study, _: study.mapping.balls,
    "points": lambda study, _: study.mapping.points,
    "radius": lambda study, _: study.mapping.radius,
    "assignment_poses": lambda study, _: study.paper_damage.poses,
    "short_searches": lambda study, _: study.search.short,
    "searches_long": lambda study, _: study.search.searches_long,
    "tests": lambda study, _: study.training.tests,
    "measure_every": lambda study, _: study.training.measure_every,
    "real_robot": lambda study, _: study.real.robot,
    "real_poses": lambda study, _: list(study.real.poses),
    "budgets": lambda study, _: list(study.benchmark.moves),
    "threshold": lambda study, _: min(study.benchmark.thresholds),
}


class Request:
    """Collects what one reader needs, and what of it the study lacks.

    Args:
        study: the study.
        trainings: all of them.
        root: the folder of its results.
        sample_at: the path of the search's sample for a training.

    Attributes:
        lacking: keys of the study that would have to say more, in the order of asking.
        foreign: whether something was asked for that is known of the shipped study alone.
    """

    def __init__(
        self, study: Study, trainings: Trainings, root: str, sample_at: Callable[[str], str]
    ):
        self.study, self.trainings = study, trainings
        self._root, self._sample_at = root, sample_at
        self._files: dict[str, str] = {}
        self._facts: dict[str, JsonValue] = {}
        self.lacking: list[str] = []
        self._beyond = self.foreign = False

    @property
    def trained(self) -> bool:
        """Whether the trainings of the study leave all that was asked for."""
        return not (self.lacking or self._beyond)

    @property
    def evidence(self) -> Evidence:
        """All that was asked for."""
        return Evidence(root=self._root, files=self._files, facts=self._facts)

    def fact(self, name: str) -> JsonValue:
        """One of `FACTS`; None where the study has no learner that it speaks of."""
        try:
            self._facts[name] = FACTS[name](self.study, self.trainings)
        except (KeyError, UnknownName):
            missing = [each for each in (IMPROVED, RITTER) if each not in self.study.learners]
            self.lack(f"learners: {missing[0]}")
        return self._facts.get(name)

    def facts(self, *names: str) -> None:
        """Several of them."""
        for name in names:
            self.fact(name)

    def lack(self, key: str) -> None:
        """Note what the study would have to say besides."""
        if key not in self.lacking:
            self.lacking.append(key)

    def files(self, *names: str) -> None:
        """Results, by their paths below the study's folder."""
        for name in names:
            self._files[name] = f"{self._root}/{name}"
            self._beyond |= name.startswith(OF_EVIDENCE)

    def shipped(self, *names: str) -> None:
        """Files of the project, about the shipped study alone, by their paths there."""
        self._beyond, self.foreign = True, not self._is_shipped
        self._files |= {name: self._in_project(name) for name in names}

    def _in_project(self, name: str) -> str:
        """Where a file lies of the project whose results these are."""
        above = takewhile(lambda part: part != RESULTS, Path(self._root).parts)
        return str(Path(*above, name))

    @property
    def _is_shipped(self) -> bool:
        return self.study.name == SHIPPED

    def history(self, learner: str | None, scenario: str | None = None, key: str = "") -> None:
        """The history of a training; on the study's own scenario unless another is given.

        Args:
            key: of the study that would bring the training; the default learners unless given.
        """
        on = scenario or self.fact("scenario")
        if learner is None:
            return
        if (on, learner) not in self.trainings.runs:
            plan = self.study.experiments
            there = on in plan.scenarios or on in self.trainings.scenarios()
            lacking = key or f"experiments.learners: {learner}"
            self.lack(lacking if there else f"experiments.scenarios: {on}")
        self.files(f"runs/{on}/{learner}.parquet")

    def ladder(self, learner: str) -> None:
        """The histories of a learner trained for several numbers of iterations."""
        if not self.fact("ladder").get(learner):
            self.lack(f"experiments.ladder.{learner}")
        for name in self.trainings.ladder(learner).values():
            self.history(name)

    def ensemble(self, learner: str, series: str) -> None:
        """A series of other damages."""
        if series not in self.study.experiments.ensemble.get(learner, ()):
            self.lack(f"experiments.ensemble.{learner}.{series}")
        self.files(f"ensemble/{series}.{learner}.parquet")

    def assignments(self) -> None:
        """The initial errors of every assignment of the paper's damage."""
        own = self.study.scenario
        if not any(isinstance(entry, Assigned) for entry in self.study.scenarios[own]):
            self.lack(f"scenarios.{own}: assigned links or encoders")
        self.files(f"assignments/{self.fact('robot')}.parquet")

    def sample(self, learner: str | None) -> None:
        """The sample of the search for a training."""
        self._beyond = True
        if learner is not None:
            path = self._sample_at(str(training(self.study, learner)))
            self._files[f"search/{learner}.csv"] = path

    def scenario(self, scenario: str | None = None) -> None:
        """A damage as resolved; the study's own unless another is given."""
        self.files(f"scenarios/{scenario or self.fact('scenario')}.json")

    def setups(self, table: str) -> bool:
        """What was measured in each alternative setup; whether all of it is there.

        Args:
            table: outcomes; or horizon, how long Ritter's takes.
        """
        names = DESIGN, *pieces(table, self.fact("setups")[table])
        paths = {name: self._in_project(name) for name in names}
        there = self._is_shipped and all(Path(path).exists() for path in paths.values())
        if there:
            self._files |= paths
        return there
