"""What a claim, a figure or a page reads, said once: a rule's inputs and arguments follow from it.

It is said in a text of patterns:

    iterations                            a fact
    mapping/visits.parquet                a result, by its path below the study's folder
    runs/{scenario}/{learners}.parquet    several, by facts: those of a list in turn
    search/*.csv                          those of all trainings
    workflow/universes/second/power.csv   what was measured once, and is shipped with the project
    outcomes                              the same of every alternative setup, in pieces
    outcomes?                             ... if it is there

What was asked for is an `Evidence`, and nothing else can be read from it. Asking loads no tables
and draws nothing, since the workflow does it whenever it starts.
"""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from itertools import product, takewhile
from pathlib import Path
from typing import Any

from recalib.errors import UnknownName
from replication.config.damages import Assigned
from replication.config.shipped import DESIGN, PIECES, RESULTS, SHIPPED, pieces
from replication.config.study import Study
from replication.config.switches import IMPROVED, RITTER, SWITCHES
from replication.judgement.results import Evidence
from replication.training.trainings import Trainings, elsewhere, ritter_short, training

# Ritter's net with as many cells as both maps: where it is trained, it leads
DOUBLE = "ritter_double"
LADDERS = IMPROVED, DOUBLE, RITTER
SWITCHED = [name for switch in SWITCHES for name in (switch.without, switch.added)]
OF_MAPS = SWITCHED[:2]  # whose searches go on from others: replicates of their own compare them
# Not from trainings: measured for a study with evidence, searched for, or shipped
BEYOND = "ensemble/", "mapping/", "search/", "workflow/"

# How each of `Facts` follows from a study. Trainings go by their role in the paper.
FACTS: Mapping[str, Callable[[Study, Trainings], Any]] = {
    "seed": lambda study, _: study.seed,
    "robot": lambda study, _: study.robot,
    "scenario": lambda study, _: study.scenario,
    "scenarios": lambda study, _: list(study.experiments.scenarios),
    "elsewhere": lambda study, _: elsewhere(study),
    "published": lambda study, _: study.paper_damage.published.model_dump(),
    "published_mm": lambda study, _: study.real.published.model_dump(),
    "iterations": lambda study, _: study.learners[IMPROVED].iterations,
    "improved": lambda _, trainings: trainings.name(IMPROVED),
    "ritter": lambda _, trainings: trainings.name(RITTER),
    "short": lambda study, trainings: trainings.name(ritter_short(study)),
    "compared": lambda study, trainings: [
        trainings.name(name)
        for name in (DOUBLE if DOUBLE in study.experiments.beside else RITTER, IMPROVED)
        if name in (*study.experiments.learners, *study.experiments.beside)
    ],
    "learners": lambda study, trainings: [
        trainings.name(name) for name in study.experiments.learners
    ],
    "beside": lambda study, _: [
        name
        for name in study.experiments.beside
        if training(study, name).iterations == study.learners[IMPROVED].iterations
    ],
    "switched": lambda study, _: [
        name for name in SWITCHED if study.experiments.switches and name not in OF_MAPS
    ],
    "ladder": lambda study, trainings: {
        name: list(map(list, trainings.ladder(name).items())) for name in study.experiments.ladder
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
        root: the folder of the study's results.
        sample_at: the path of the search's sample for a training.

    Attributes:
        lacking: keys of the study that would have to say more, in the order of asking.
    """

    def __init__(
        self, study: Study, trainings: Trainings, root: str, sample_at: Callable[[str], str]
    ):
        self.study, self.trainings = study, trainings
        self._root, self._sample_at = root, sample_at
        self._files: dict[str, str] = {}
        self._facts: dict[str, Any] = {}
        self.lacking: list[str] = []

    @property
    def trained(self) -> bool:
        """Whether the trainings of the study leave all that was asked for."""
        return not (self.lacking or any(name.startswith(BEYOND) for name in self._files))

    @property
    def foreign(self) -> bool:
        """Whether something was asked for that is known of the shipped study alone."""
        shipped = any(name.startswith("workflow/") for name in self._files)
        return shipped and not self._is_shipped

    @property
    def evidence(self) -> Evidence:
        """All that was asked for."""
        return Evidence.model_validate(
            {"root": self._root, "files": self._files, "facts": self._facts}
        )

    def read(self, needs: str) -> "Request":
        """Ask for what these patterns, with spaces between them, mean."""
        for pattern in needs.split():
            name, optional = pattern.removesuffix("?"), pattern.endswith("?")
            if name in PIECES:
                self._setups(name, optional)
            elif name in FACTS:
                self._fact(name)
            else:
                for path in self._paths(name):
                    self._file(path, optional)
        return self

    def _fact(self, name: str) -> Any:
        """None where the study has no learner that it speaks of."""
        try:
            value = self._facts[name] = FACTS[name](self.study, self.trainings)
            self._lack(*_lacking_for(name, value, self.study))
        except (KeyError, UnknownName):
            missing = [name for name in (IMPROVED, RITTER) if name not in self.study.learners]
            self._lack(f"learners: {missing[0]}")
        return self._facts.get(name)

    def _lack(self, *keys: str) -> None:
        self.lacking += [key for key in keys if key not in self.lacking]

    def _paths(self, pattern: str) -> Iterator[str]:
        if "*" in pattern:
            scenarios, learners = zip(*self.trainings.runs, strict=True)
            every = scenarios if pattern.startswith("scenarios/") else learners
            yield from (pattern.replace("*", name) for name in dict.fromkeys(every))
            return
        facts = re.findall(r"{(\w+)}", pattern)
        for names in product(*(_names(self._fact(fact)) for fact in facts)):
            yield pattern.format(**dict(zip(facts, names, strict=True)))

    def _file(self, path: str, optional: bool) -> None:
        folder, *names = path.rpartition(".")[0].split("/")
        match folder:
            case "workflow":
                if self._is_shipped or not optional:
                    self._files[path] = self._in_project(path)
                return
            case "search":
                self._files[path] = self._sample_at(str(training(self.study, names[0])))
                return
            case "runs":
                self._lack(*self._untrained(*names))
            case "ensemble":
                series, learner = names[0].split(".")
                if series not in self.study.experiments.ensemble.get(learner, ()):
                    self._lack(f"experiments.ensemble.{learner}.{series}")
            case "assignments":
                own = self.study.scenario
                if not any(isinstance(entry, Assigned) for entry in self.study.scenarios[own]):
                    self._lack(f"scenarios.{own}: assigned links or encoders")
        self._files[path] = f"{self._root}/{path}"

    def _untrained(self, scenario: str, learner: str) -> Iterator[str]:
        """The key that would bring a training."""
        if (scenario, learner) in self.trainings.runs:
            return
        if scenario not in (*self.study.experiments.scenarios, *self.trainings.scenarios()):
            yield f"experiments.scenarios: {scenario}"
        elif learner in SWITCHED:
            yield "experiments.switches: true"
        else:
            yield f"experiments.learners: {learner}"

    def _setups(self, table: str, optional: bool) -> None:
        names = DESIGN, *pieces(table, self._fact("setups")[table])
        paths = {name: self._in_project(name) for name in names}
        if self._is_shipped and all(Path(path).exists() for path in paths.values()):
            self._files |= paths
        elif not optional:
            self._lack(f"universes: {table}")

    def _in_project(self, name: str) -> str:
        """Where a file lies of the project whose results these are."""
        above = takewhile(lambda part: part != RESULTS, Path(self._root).parts)
        return str(Path(*above, name))

    @property
    def _is_shipped(self) -> bool:
        return self.study.name == SHIPPED


def _lacking_for(fact: str, value: Any, study: Study) -> Iterator[str]:
    """What a study would have to say for a fact to tell what it is read for."""
    plan = study.experiments
    if fact == "beside" and not (value or plan.switches):
        yield "experiments.switches: true"
    if fact == "ladder":
        yield from (f"experiments.ladder.{name}" for name in LADDERS if not plan.ladder.get(name))
        own = study.learners[IMPROVED].iterations
        if own not in plan.ladder.get(IMPROVED, ()):
            yield f"experiments.ladder.{IMPROVED}: {own}"


def _names(fact: Any) -> Iterable[str]:
    """The names in a fact, however deep."""
    match fact:
        case str():
            return [fact]
        case dict():
            return _names(list(fact.values()))
        case list():
            return [name for part in fact for name in _names(part)]
    return []
