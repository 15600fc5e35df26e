"""What a claim, a figure or a page reads: asked for once, and the rule's input and parameters.

`Request` is asked by the same names by which `Evidence` is read afterwards. Declaring loads no
tables and draws nothing, since the workflow does it whenever it starts.
"""

from collections.abc import Callable, Mapping
from pathlib import Path

from pydantic import JsonValue

from recalib.errors import UnknownName
from recalib.study.configuration.damages import Assigned
from recalib.study.configuration.part import Frozen
from recalib.study.configuration.study import Study
from recalib.study.configuration.switches import IMPROVED, RITTER
from recalib.study.layout import (
    DESIGN,
    DEVIATIONS,
    EFFORTS,
    FIRST,
    POWER,
    REFERENCE,
    SECOND,
    SHIPPED,
    Layout,
    pieces,
)
from recalib.study.plan import Plan
from recalib.study.trainings import Trainings, elsewhere, ritter_short, training

# Ritter's net with as many cells as both maps: where it is trained, it leads
DOUBLE = "ritter_double"

# What may be known of a study beside its results. Trainings go by their role in the paper.
FACTS: Mapping[str, Callable[[Study, Trainings], JsonValue]] = {
    "shipped": lambda study, _: study.name == SHIPPED,
    "seed": lambda study, _: study.seed,
    "robot": lambda study, _: study.robot,
    "scenario": lambda study, _: study.scenario,
    "scenarios": lambda study, _: list(study.experiments.scenarios),
    "recordings": lambda study, _: Plan(study).recordings(),
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


class Needs(Frozen):
    """What one reader may read.

    Attributes:
        root: folder of the study's results.
        files: paths of results.
        samples: paths of samples of the search, by training.
        facts: of the study.
    """

    root: str
    files: tuple[str, ...]
    samples: dict[str, str]
    facts: dict[str, JsonValue]

    @property
    def inputs(self) -> list[str]:
        """All files."""
        return [*self.files, *self.samples.values()]


class Request:
    """Collects what one reader needs, and what of it the study lacks.

    Args:
        study: the study.
        trainings: all of them.
        layout: of its results.
        sample_at: the path of the search's sample for a training.

    Attributes:
        lacking: keys of the study that would have to say more, in the order of asking.
        foreign: whether something was asked for that is known of the shipped study alone.
    """

    def __init__(
        self,
        study: Study,
        trainings: Trainings,
        layout: Layout,
        sample_at: Callable[[str], str],
    ):
        self.study, self.trainings = study, trainings
        self._layout, self._sample_at = layout, sample_at
        self._files: dict[str, None] = {}
        self._samples: dict[str, str] = {}
        self._facts: dict[str, JsonValue] = {}
        self.lacking: list[str] = []
        self._beyond = self.foreign = False

    @property
    def trained(self) -> bool:
        """Whether the trainings of the study leave all that was asked for."""
        return not (self.lacking or self._beyond)

    @property
    def needs(self) -> Needs:
        """All that was asked for."""
        return Needs(
            root=self._layout.root,
            files=tuple(self._files),
            samples=self._samples,
            facts=self._facts,
        )

    def fact(self, name: str) -> JsonValue:
        """One of `FACTS`; None where the study has no learner that it speaks of."""
        try:
            self._facts[name] = FACTS[name](self.study, self.trainings)
        except (KeyError, UnknownName):
            missing = [each for each in (IMPROVED, RITTER) if each not in self.study.learners]
            self.lack(f"learners: {missing[0]}")
        return self._facts.get(name)

    def lack(self, key: str) -> None:
        """Note what the study would have to say besides."""
        if key not in self.lacking:
            self.lacking.append(key)

    def _result(self, path: str) -> None:
        self._files[path] = None

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
        self._result(self._layout.history(on, learner))

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
        self._beyond = True
        self._result(self._layout.ensemble(series, learner))

    def mapping(self, name: str) -> None:
        """A measurement without a learner: coupling, propagation, quantisation, visits, replay."""
        self._beyond = True
        self._result(self._layout.mapping(name))

    def assignments(self) -> None:
        """The initial errors of every assignment of the paper's damage."""
        own = self.study.scenario
        if not any(isinstance(entry, Assigned) for entry in self.study.scenarios[own]):
            self.lack(f"scenarios.{own}: assigned links or encoders")
        self._result(self._layout.assignments(self.fact("robot")))

    def sample(self, learner: str | None) -> None:
        """The sample of the search for a training."""
        self._beyond = True
        if learner is not None:
            self._samples[learner] = self._sample_at(str(training(self.study, learner)))

    def scenario(self, scenario: str | None = None) -> None:
        """A damage as resolved; the study's own unless another is given."""
        self._result(self._layout.scenario(scenario or self.fact("scenario")))

    def summary(self) -> None:
        """The first and the last errors of every training."""
        self._result(self._layout.summary)

    def claims(self) -> None:
        """The judged claims."""
        self._result(self._layout.claims)

    def deviations(self) -> None:
        """What changed after a result had been seen."""
        self._result(DEVIATIONS)

    def reference(self) -> None:
        """The reference study measured as the alternative setups are."""
        self._shipped(self._layout.shipped(REFERENCE))

    def setups(self, table: str) -> bool:
        """What was measured in each alternative setup; whether all of it is there.

        Args:
            table: outcomes; or horizon, how long Ritter's takes.
        """
        measured = pieces(table, self.fact("setups")[table], self._layout.shipped(SECOND))
        there = self._is_shipped and all(Path(path).exists() for path in measured)
        for path in (DESIGN, *measured) if there else ():
            self._result(path)
        return there

    def efforts(self) -> None:
        """The trainings for the factor of 70, by the effort of their searches."""
        self._shipped(self._layout.shipped(EFFORTS))

    def power(self) -> None:
        """What the campaign can find."""
        self._shipped(POWER)

    def first_campaign(self) -> None:
        """The design and the outcomes of the first campaign."""
        self._shipped(f"{FIRST}/design.csv", f"{FIRST}/outcomes.csv")

    @property
    def _is_shipped(self) -> bool:
        return self.study.name == SHIPPED

    def _shipped(self, *paths: str) -> None:
        """Tables that were measured of the shipped study alone, and lie in the project."""
        self._beyond, self.foreign = True, not self._is_shipped
        for path in paths:
            self._result(path)

    def benchmark(self) -> None:
        """Errors of every learner against moves."""
        self._result(self._layout.benchmark)

    def benchmark_moves(self) -> None:
        """Moves to each threshold."""
        self._result(self._layout.benchmark_moves)

    def real(self) -> None:
        """Errors on the real arm."""
        self._result(self._layout.real)
