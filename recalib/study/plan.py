"""From a study to what each of its jobs needs."""

import hashlib
from collections.abc import Iterable
from pathlib import Path

from recalib.errors import UnknownName
from recalib.study import jobs
from recalib.study.configuration.damages import Assigned
from recalib.study.configuration.part import Part
from recalib.study.configuration.study import Amounts, Budget, Learner, Study
from recalib.study.configuration.switches import IMPROVED
from recalib.study.trainings import Trainings, rules, scenario_of, training

SIDE_BY_SIDE = 5  # scenarios in a job: many robots solved in one call take half the time a move
TODAYS, FEW = "geometric", 5  # the learner that is recorded beside the paper's, and its moves


def chunks(total: int, size: int) -> list[int]:
    """The numbers of the chunks into which so many seeds, trials or robots are cut."""
    return list(range(-(-total // size)))


def bounds(chunk: int, total: int, size: int) -> dict[str, int]:
    """The first of a chunk, and one past its last."""
    return {"first": chunk * size, "last": min((chunk + 1) * size, total)}


def digest_of(files: Iterable[Path]) -> str:
    """Of what stands in files."""
    each = (hashlib.sha256(file.read_bytes()).hexdigest() for file in files)
    return hashlib.sha256("".join(each).encode()).hexdigest()


def _only(kind: type[Part], part: Part) -> Part:
    """What a part of the configuration shares with the poorer kind that it is built upon."""
    return kind.model_construct(**{name: getattr(part, name) for name in kind.model_fields})


class Plan:
    """What each job of a study needs.

    Args:
        study: the study.
    """

    def __init__(self, study: Study):
        self.study = study

    def nominal(self, robot: str) -> jobs.Nominal:
        """A robot and its controller. See `find_urdf` for what it raises."""
        from recalib.nominal.descriptions import find_urdf

        entry, controller = self.study.robots[robot], self.study.controller
        digest = digest_of([find_urdf(entry.urdf)])
        return jobs.Nominal(name=robot, robot=entry, controller=controller, urdf_sha256=digest)

    def assignments(self, robot: str) -> jobs.Assignments:
        """Every assignment of the paper's damage to a robot."""
        damage, seed = self.study.paper_damage, self.study.seed
        return jobs.Assignments(nominal=self.nominal(robot), damage=damage, seed=seed)

    def design(self) -> jobs.Design:
        """The design of the multiverse."""
        study = self.study
        names = dict.fromkeys([study.robot, *study.universes.factors.robot])
        return jobs.Design(
            plan=study.universes,
            robots=[self.nominal(name) for name in names],
            damage=study.paper_damage,
            moved=study.scenarios["translation_rotation"],
        )

    def efforts(self, learner: str) -> jobs.Efforts:
        """The winners of full and of rough searches for a training."""
        study = self.study
        return jobs.Efforts(
            learner=rules(study, learner),
            rough=study.universes.rough_trials,
            seeds=study.training.seeds,
            tests=study.training.tests,
            seed=study.seed,
        )

    def scenario(self, scenario: str) -> jobs.Scenario:
        """The damage of `NAME` or `NAME-ROBOT`."""
        name, robot = scenario_of(self.study, scenario)
        return jobs.Scenario(
            name=scenario,
            nominal=self.nominal(robot),
            damages=self.study.scenarios[name],
            poses=self.study.paper_damage.poses,
            seed=self.study.seed,
        )

    def searches(self, learner: str) -> int:
        """How many independent searches there are for a learner."""
        plan = self.study.search
        short = training(self.study, learner).iterations <= plan.short
        return plan.searches if short else plan.searches_long

    def seeds(self, learner: str) -> int:
        """How many seeds a learner is trained with, those of all its searches."""
        return self.searches(learner) * self.study.training.seeds

    def measuring(self) -> jobs.Measuring:
        """How trainings are measured."""
        plan = self.study.training
        return jobs.Measuring(
            tests=plan.tests,
            every=plan.measure_every,
            evenly=plan.measure_evenly,
            measurements=plan.measurements,
        )

    def training_chunks(self, learner: str) -> list[int]:
        """The chunks of a training."""
        return chunks(self.seeds(learner), self.study.training.seeds_per_job)

    def training(self, scenario: str, learner: str, chunk: int) -> jobs.Training:
        """Some seeds of a training."""
        _, robot = scenario_of(self.study, scenario)
        shown = *self.study.experiments.learners, *self.study.experiments.beside
        return jobs.Training(
            scenario=scenario,
            learner=rules(self.study, learner),
            seeds=self.study.training.seeds,
            **bounds(chunk, self.seeds(learner), self.study.training.seeds_per_job),
            measuring=self.measuring(),
            throughout=robot == self.study.robot and learner in shown,
            seed=self.study.seed,
        )

    def searches_per_job(self, learner: str) -> int:
        """How many searches for a learner one job does."""
        most, each = self.study.search.iterations_per_job, training(self.study, learner).iterations
        return max(1, most // each)

    def search_chunks(self, learner: str) -> list[int]:
        """The chunks of the searches for a training."""
        return chunks(self.searches(learner), self.searches_per_job(learner))

    def budget(self) -> Budget:
        """What a search may spend."""
        return _only(Budget, self.study.search)

    def search(self, learner: str, chunk: int) -> jobs.Searches:
        """Some of the searches for a training."""
        return jobs.Searches(
            training=learner,
            learner=rules(self.study, learner),
            budget=self.budget(),
            **bounds(chunk, self.searches(learner), self.searches_per_job(learner)),
            tests=self.study.training.tests,
        )

    def sample(self, learner: str) -> jobs.Sample:
        """All trials of the searches for a training."""
        study = self.study
        return jobs.Sample(
            learner=rules(study, learner),
            searches=self.searches(learner),
            budget=self.budget(),
            robot=study.robot,
            scenario=study.scenario,
        )

    def draw_chunks(self, series: str, learner: str) -> list[int]:
        """The chunks of a series of other damages."""
        plan = self.study.experiments
        return chunks(plan.ensemble[learner][series].draws, plan.draws_per_job)

    def draws(self, series: str, learner: str, chunk: int) -> jobs.Draws:
        """Some robots of a series of other damages."""
        plan = self.study.experiments
        its = plan.ensemble[learner][series]
        return jobs.Draws(
            nominal=self.nominal(self.study.robot),
            damage=_only(Amounts, self.study.paper_damage),
            series=series,
            plan=its,
            **bounds(chunk, its.draws, plan.draws_per_job),
            learner=rules(self.study, learner),
            tests=self.study.training.tests,
            seed=self.study.seed,
        )

    def true_mapping(self) -> jobs.TrueMapping:
        """Measurements of the true mapping."""
        return jobs.TrueMapping(plan=self.study.mapping, seed=self.study.seed)

    def visits(self) -> jobs.Visits:
        """The Monte Carlo of the expected learning."""
        return jobs.Visits(seed=self.study.seed)

    def replay(self) -> jobs.Replay:
        """A training by a robot, and by a table."""
        return jobs.Replay(learner=rules(self.study, IMPROVED), seed=self.study.seed)

    def batches(self) -> dict[str, list[str]]:
        """The benchmark's scenarios that share a job, and so a robot, by their batch."""
        by_robot: dict[str, list[str]] = {}
        for name in self.study.benchmark.scenarios:
            by_robot.setdefault(scenario_of(self.study, name)[1], []).append(name)
        shared = [
            own[first : first + SIDE_BY_SIDE]
            for own in by_robot.values()
            for first in range(0, len(own), SIDE_BY_SIDE)
        ]
        return {str(number): batch for number, batch in enumerate(shared)}

    def benchmark(self, learner: str, batch: str) -> jobs.Benchmark:
        """A learner on scenarios that share a job."""
        study, plan = self.study, self.study.benchmark
        return jobs.Benchmark(
            name=learner,
            learner=self._rules_unless_peer(learner),
            scenarios=self.batches()[batch],
            seeds=plan.seeds,
            moves=plan.moves,
            longer=plan.longer,
            tests=study.training.tests,
            seed=study.seed,
        )

    def _rules_unless_peer(self, learner: str) -> Learner | None:
        try:
            return rules(self.study, learner)
        except UnknownName:  # one of today's, which have no settings: names were checked before
            return None

    def real_data(self, part: str) -> jobs.RealData:
        """A recording of the real arm."""
        return jobs.RealData(source=getattr(self.study.real.data, part))

    def real_run(self, learner: str) -> jobs.RealRun:
        """A learner on recorded poses."""
        plan = self.study.real
        return jobs.RealRun(
            nominal=self.nominal(plan.robot),
            learner=learner,
            poses=plan.poses,
            subsets=plan.subsets,
            seed=self.study.seed,
        )

    def real_twin(self, learner: str) -> jobs.RealTwin:
        """A learner of the paper on the twin of the real arm."""
        plan = self.study.real
        return jobs.RealTwin(
            nominal=self.nominal(plan.robot),
            name=learner,
            learner=rules(self.study, learner),
            poses=plan.poses,
            subsets=plan.subsets,
            tests=self.study.training.tests,
            seed=self.study.seed,
        )

    def summary(self) -> jobs.Summary:
        """The final errors of every training."""
        return jobs.Summary(trainings=Trainings(self.study).runs, seed=self.study.seed)

    def benchmark_table(self) -> jobs.BenchmarkTable:
        """The tables of the benchmark."""
        plan = self.study.benchmark
        return jobs.BenchmarkTable(
            scenarios=plan.scenarios,
            learners=plan.learners,
            thresholds=plan.thresholds,
            seed=self.study.seed,
        )

    def real_table(self) -> jobs.RealTable:
        """The errors on the real arm."""
        return jobs.RealTable(seed=self.study.seed)

    def recorded(self) -> list[str]:
        """The learners that are recorded side by side: those of the shortest trainings."""
        named = self.study.experiments.learners
        iterations = {name: training(self.study, name).iterations for name in named}
        return [name for name in named if iterations[name] == min(iterations.values())]

    def recordings(self) -> list[str]:
        """The names of all recordings; none of a study without a learner that is recorded."""
        its = self.study.experiments.scenarios if self.recorded() else ()
        own = self.study.scenario
        return [*its, *([f"{own}.today"] if own in its else [])]

    def recording(self, name: str) -> jobs.Recording:
        """The recording of a scenario; SCENARIO.today: of one of today's learners beside a map.

        What is published belongs to the paper's damage.
        """
        from recalib.meshes import mesh_files
        from recalib.nominal.descriptions import find_urdf

        scenario, _, today = name.partition(".")
        robot = self.study.robots[scenario_of(self.study, scenario)[1]]
        own, published = self.study.scenario, self.study.paper_damage.published
        assigned = any(isinstance(entry, Assigned) for entry in self.study.scenarios[own])
        papers = {learner: rules(self.study, learner) for learner in self.recorded()}
        first = next(iter(papers))
        return jobs.Recording(
            scenario=scenario,
            learners={TODAYS: None, first: papers[first]} if today else papers,
            moves=FEW,
            measuring=self.measuring(),
            seed=self.study.seed,
            published=published.model_dump() if assigned and scenario == own else {},
            meshes_sha256=digest_of(mesh_files(find_urdf(robot.urdf))),
        )

    def speed(self, learners: Iterable[str]) -> jobs.Speed:
        """The learners whose speed is measured."""
        return jobs.Speed(learners={name: rules(self.study, name) for name in learners})
