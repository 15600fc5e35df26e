"""How much a study asks for: what would end in the middle of the night, without memory or time."""

import math
from collections.abc import Iterator
from functools import reduce
from typing import NamedTuple

from recalib.study.chunks import SIDE_BY_SIDE, searches_per_job
from recalib.study.configuration.messages import KeyPath, Mistake, dotted, unlike
from recalib.study.configuration.study import Study
from recalib.study.entrants import PEERS
from recalib.study.trainings import Trainings, rules, searches, seeds, training

MEMORY = 4e9  # bytes of one job
JOBS = 20_000  # of one study: Snakemake looks at all of them before it starts
NUMBER = 8  # bytes
POSE = 60  # numbers for a pose on which is measured, with all that is computed on the way
CELL = 6 + 36  # numbers in a cell: theta and a Jacobian
ANGLE = 40  # numbers for joint angles that are tried, and where they take the tool


class Size(NamedTuple):
    """What multiplies to the size of something.

    Attributes:
        keys: those of the study that say so, each with how much.
        amount: the size.
    """

    keys: dict[KeyPath, float]
    amount: float


def check_sizes(study: Study) -> Iterator[Mistake]:
    """Jobs that need more memory than there is, or more of them than one can wait for."""
    for size in (*_of_learners(study), *_of_peers(study), _of_assignments(study)):
        if size.amount > MEMORY:
            need = f"a job would need {size.amount / 1e9:,.0f} GB, more than {MEMORY / 1e9:.0f}"
            yield _less(study, size, need)
            return  # others would say the same
    if (jobs := _jobs(study)).amount > JOBS:
        yield _less(study, jobs, f"there would be {jobs.amount:,.0f} jobs, more than {JOBS:,}")


def _less(study: Study, size: Size, otherwise: str) -> Mistake:
    """The largest is blamed; what else would help is named."""
    most, *others = sorted(size.keys, key=lambda key: -size.keys[key])
    stood = reduce(lambda part, key: part[key], most, study.model_dump(mode="json"))
    also = "".join(f", or of {dotted(key)}" for key in others)
    return unlike(most, stood, f"less of it{also}: {otherwise}")


def _of_learners(study: Study) -> Iterator[Size]:
    """The runs that a job trains side by side, and all that were trained, put together."""
    experiments, every = study.experiments, study.training
    tests = {("training", "tests"): every.tests}
    for name in dict.fromkeys(learner for _, learner in Trainings(study).runs):
        per_job = {("training", "seeds_per_job"): every.seeds_per_job}
        trained, all_ = min(every.seeds_per_job, seeds(study, name)), seeds(study, name)
        searched = {("search", "trials"): study.search.trials}
        searched[("search", "seeds")] = study.search.seeds
        said = {("training", "seeds"): every.seeds}
        yield _side_by_side(study, name, trained, per_job | tests)
        yield _side_by_side(study, name, study.search.trials * study.search.seeds, searched | tests)
        cells, state = _cells(study, name)
        yield Size(said | cells, all_ * state)
    for learner, series in experiments.ensemble.items():
        for name, its in series.items():
            draws = {("experiments", "ensemble", learner, name, "draws"): its.draws}
            draws[("experiments", "draws_per_job")] = experiments.draws_per_job
            robots = min(its.draws, experiments.draws_per_job) * len(its.scales)
            yield _side_by_side(study, learner, robots, draws | tests)
    for learner in set(study.benchmark.learners) - set(PEERS):
        said = {("benchmark", "seeds"): study.benchmark.seeds}
        runs = study.benchmark.seeds * min(SIDE_BY_SIDE, len(study.benchmark.scenarios))
        yield _side_by_side(study, learner, runs, said | tests)
    for learner in study.real.twin:
        subsets = {("real", "subsets"): study.real.subsets}
        yield _side_by_side(study, learner, study.real.subsets, subsets | tests)


def _cells(study: Study, learner: str) -> tuple[dict[KeyPath, float], float]:
    """The keys of a learner's cells, and the bytes of what a run learns."""
    its, name = rules(study, learner), training(study, learner).name
    cells = math.prod(its.supernet) * math.prod(its.subnet)
    keys = {("learners", name, "supernet"): math.prod(its.supernet)}
    keys[("learners", name, "subnet")] = math.prod(its.subnet)
    known = {key: count for key, count in keys.items() if name in study.learners}
    return known, NUMBER * CELL * cells


def _side_by_side(study: Study, learner: str, runs: int, keys: dict[KeyPath, float]) -> Size:
    """Runs with what they learn, their poses, and the poses on which they are measured."""
    cells, state = _cells(study, learner)
    its, named = training(study, learner), study.learners
    if its.name in named and its.iterations == named[its.name].iterations:
        said = "learners", its.name, "iterations"
    elif its.iterations in study.experiments.ladder.get(its.name, ()):
        said = "experiments", "ladder", its.name
    else:
        said = "experiments", "learners"
    poses = NUMBER * (6 * its.iterations + POSE * study.training.tests)
    return Size(keys | cells | {said: its.iterations}, runs * (state + poses))


def _of_peers(study: Study) -> Iterator[Size]:
    """A Gaussian process knows how each of its moves goes with each other."""
    plan = study.benchmark
    if set(plan.learners) & set(PEERS):
        runs = plan.seeds * min(SIDE_BY_SIDE, len(plan.scenarios))
        keys = {("benchmark", "moves"): max(plan.moves), ("benchmark", "seeds"): plan.seeds}
        yield Size(keys, NUMBER * runs * max(plan.moves) ** 2)


def _of_assignments(study: Study) -> Size:
    """All ways to shift the encoders are tried together."""
    damage, joints = study.paper_damage, len(study.robots[study.robot].home)
    ways = math.perm(joints, len(damage.shift)) * 2 ** len(damage.shift)
    keys = {("paper_damage", "poses"): damage.poses, ("paper_damage", "shift"): len(damage.shift)}
    return Size(keys, NUMBER * ANGLE * ways * damage.poses)


def _jobs(study: Study) -> Size:
    """Chunks of trainings and searches."""
    every, trainings = study.training, Trainings(study)
    trained = sum(seeds(study, name) / every.seeds_per_job for _, name in trainings.runs)
    searched = sum(
        searches(study, name) / searches_per_job(study, name) for name in trainings.tuned()
    )
    drawn = sum(
        its.draws / study.experiments.draws_per_job
        for series in study.experiments.ensemble.values()
        for its in series.values()
    )
    keys = {
        ("training", "seeds"): every.seeds,
        ("search", "searches"): study.search.searches,
        ("search", "searches_long"): study.search.searches_long,
    }
    return Size(keys, trained + searched + drawn)
