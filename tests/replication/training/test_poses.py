"""What settings are chosen by, no result is measured on: neither by a slip nor in any job."""

import zlib
from collections.abc import Iterator
from functools import partial

import numpy as np
import pandas as pd
import pytest

from recalib.damaged.disturbances import Noise
from recalib.loop.training import History
from replication.campaign import efforts, horizon, measuring
from replication.campaign.design import read_design
from replication.campaign.universe import universe
from replication.config.damages import Assigned
from replication.config.shipped import DESIGN, SEARCHED
from replication.scenarios.plants import resolve
from replication.training import (
    benchmark,
    campaign,
    constant_widths,
    ensemble,
    real_arm,
    replay,
    trials,
)
from replication.training import poses as its
from replication.training.chunks import chunks, searches_per_job
from replication.training.poses import ResultPoses, SearchPoses, Stream, train_for_results
from replication.training.trainings import Trainings, searches, seeds, training
from replication.training.trials import Search, search_for
from tests.conftest import ROOT
from tests.test_architecture import imported
from workflow.scripts.call import write

SEARCHED_ON = {"number": 1, "training": "improved_4", "scenario": "links"}


def for_a_search():
    return Stream.SEARCH.draw(1, [0, 1], 4, 3, **SEARCHED_ON)


def for_results():
    return Stream.SCENARIO.draw(1, [0, 1], 4, 3, scenario="links")


def test_a_search_takes_no_poses_of_results():
    with pytest.raises(TypeError, match="SearchPoses expected, ResultPoses found: links"):
        Search(None, None, None, for_results())


def test_results_take_no_poses_of_a_search():
    with pytest.raises(TypeError, match="ResultPoses expected, SearchPoses found: search 1 for"):
        train_for_results(None, None, for_a_search(), [4])


@pytest.mark.parametrize("kind", [SearchPoses, ResultPoses])
def test_nobody_is_measured_where_it_learned(kind):
    drawn = for_results()
    drawn.tests[1, 2] = drawn.desired[1, 3]  # a single one of them
    with pytest.raises(ValueError, match="links: test poses are among those to learn from"):
        kind("links", drawn.desired, drawn.tests)


@pytest.mark.parametrize("stream", Stream)
def test_a_stream_is_of_a_search_or_of_results_by_its_name(stream):
    drawn = stream.draw(1, [0], 4, 3, **SEARCHED_ON, replicate=0)
    assert isinstance(drawn, SearchPoses) == drawn.name.startswith("search ")
    assert isinstance(drawn, ResultPoses) != isinstance(drawn, SearchPoses)


def test_results_cannot_take_the_name_of_a_search():
    with pytest.raises(ValueError, match="SCENARIO: 'search 1 for improved_4 on links' is the"):
        Stream.SCENARIO.draw(1, [0, 1], 4, 3, scenario=for_a_search().name)


def test_nobody_trains_past_the_types():
    modules = (ROOT / "recalib" / "study").rglob("*.py")
    train = {path.stem for path in modules if "recalib.loop.training.train" in imported(path)}
    assert train == {"poses"}


def test_a_search_meets_none_of_the_noise_that_results_meet(study, rules, tmp_path, monkeypatch):
    """Settings that suit one noise would be measured with it again."""
    met = []

    def train(plant, learner, desired, tests, measure_at, **how):
        moves = plant.execute(np.zeros((len(desired), 4, 6))).achieved
        met.append(moves.reshape(-1, 6))
        return nothing_learned(desired, measure_at)

    monkeypatch.setattr(its, "train", train)
    noise, sample = tmp_path / "noise.json", ROOT / SEARCHED / "improved_200.csv"
    noisy = rules.arguments(study, "scenario", scenario="noise") | {"damages": (Noise(1e-3, 1e-3),)}
    write(noise, resolve(**noisy))
    job = rules.arguments(study, "search", training="improved_200", chunk=0)
    less = job["budget"].model_copy(update={"rounds": 1, "trials": 2})
    search_for(noise, **job | {"budget": less, "last": 2})
    job = rules.arguments(study, "train", scenario="noise", learner="improved", chunk=0)
    campaign.train_seeds(noise, sample, tmp_path / "learned.npz", **job)
    first, second, results = met
    for one, other in ((first, second), (first, results), (second, results)):
        assert not np.isin(one, other).any()


def nothing_learned(desired, measure_at):
    """A history without a training."""
    errors = np.ones((len(desired), len(measure_at), 3))
    moves, refused = np.zeros(len(measure_at), int), np.zeros(errors.shape[:2], int)
    return History(np.array(measure_at), moves, refused, errors, errors)


class Drawn:
    """All poses that jobs draw; nothing is trained, and nothing searched."""

    def __init__(self, monkeypatch):
        self.learned, self.tests = [], {SearchPoses: [], ResultPoses: []}
        draw = Stream.draw

        def noted(stream, *arguments, **words):
            drawn = draw(stream, *arguments, **words)
            self.learned.append(self._keys(drawn.desired))
            self.tests[type(drawn)].append(self._keys(drawn.tests))
            return drawn

        def train(plant, learner, desired, tests, measure_at, **how):
            return nothing_learned(desired, measure_at)

        monkeypatch.setattr(Stream, "draw", noted)
        monkeypatch.setattr(its, "train", train)
        monkeypatch.setattr(Search, "all_rounds", lambda search: self._trials(search.rules))
        monkeypatch.setattr(Search, "further", lambda search, _: self._trials(search.rules))

    @staticmethod
    def _keys(poses):
        """A number for each pose: two poses with the same number would be a great coincidence."""
        first, second = poses[..., :2].reshape(-1, 2).view(np.uint64).T
        return first * np.uint64(0x9E3779B97F4A7C15) + second

    @staticmethod
    def _trials(rules):
        trials_ = pd.DataFrame(1.0, index=range(4), columns=trials.search.columns(rules))
        errors = {"position_error_cm": 1.0, "orientation_error_deg": 1.0, "score": 1.0}
        return trials_.assign(round=1, **errors)


@pytest.fixture
def drawn(monkeypatch):
    return Drawn(monkeypatch)


@pytest.fixture
def without_data(monkeypatch):
    """A twin of no arm: its poses are drawn all the same."""
    said = type("Said", (), {"target": np.eye(4)})
    monkeypatch.setattr(real_arm, "read_whole_description", lambda _: said)
    for name in ("read_of", "identified", "Plant"):
        monkeypatch.setattr(real_arm, name, lambda *_: None)


def jobs_of(study, rules, folder) -> Iterator[tuple[list[str], partial]]:
    """All jobs of a study that learn, with the streams of their poses."""
    own, trainings = study.scenario, Trainings(study)

    def sample(name):
        return ROOT / SEARCHED / f"{training(study, name)}.csv"

    def resolved(name):
        path = folder / f"{name}.json"
        if not path.exists():
            job = rules.arguments(study, "scenario", scenario=name)
            there = any(isinstance(entry, Assigned) for entry in job["damages"])
            write(path, resolve(**job | ({"damages": ()} if there else {})))
        return path

    def job(function, rule, *files, **which):
        return partial(function, *files, **rules.arguments(study, rule, **which))

    for scenario, learner in trainings.runs:
        files = resolved(scenario), sample(learner), folder / "learned.npz"
        for chunk in chunks(seeds(study, learner), study.training.seeds_per_job):
            which = {"scenario": scenario, "learner": learner, "chunk": chunk}
            yield [scenario], job(campaign.train_seeds, "train", *files, **which)
    longest = trainings.tuned()[0]  # the others see the first of its poses
    files = resolved(own), sample(longest)
    yield ["efforts"], job(efforts.efforts, "efforts_of", *files, training=longest)
    for name in trainings.tuned():
        for chunk in chunks(searches(study, name), searches_per_job(study, name)):
            its = job(search_for, "search", resolved(own), training=name, chunk=chunk)
            numbers = range(1 + its.keywords["first"], 1 + its.keywords["last"])
            yield [f"search {number} for {name} on {own}" for number in numbers], its
    for learner, series in study.experiments.ensemble.items():
        for name, robots in series.items():
            for chunk in chunks(robots.draws, study.experiments.draws_per_job):
                which = {"series": name, "learner": learner, "chunk": chunk}
                its = job(ensemble.train_draws, "ensemble_chunk", sample(learner), **which)
                yield ["ensemble"], its
    for learner in study.benchmark.learners:
        scenarios = [*map(resolved, study.benchmark.scenarios)]
        its = job(benchmark.compete, "benchmark_run", scenarios, learner=learner)
        file = its.keywords["rules"] and sample(learner)
        yield [*study.benchmark.scenarios], partial(its, sample=file)
    for name in study.real.twin:
        files = "", "", sample(name)
        yield ["twin"], job(real_arm.learn_on_twin, "real_twin", *files, learner=name)
    yield ["replay"], job(replay.replay, "study_replay", resolved(own), sample("improved"))
    searched = [f"search 1 for {name} widths on {own}" for name in constant_widths.WIDTHS]
    its = job(constant_widths.constant_widths, "study_widths", resolved(own))
    yield ["constant widths", *searched], its


@pytest.mark.usefixtures("drawn", "without_data")
def test_every_kind_of_job_draws_by_the_seed_that_it_is_told_from_its_own_stream(
    study, rules, roots, tmp_path
):
    """The root of all randomness of a job, (seed, first key): nothing else, of nobody else."""
    few = {"learners": ("improved",), "ladder": {}, "beside": (), "switches": False}
    search = study.search.model_copy(update={"seed": 77})
    plan = study.experiments.model_copy(update=few)
    study = study.model_copy(update={"seed": 77, "search": search, "experiments": plan})
    of_robots = (77, zlib.crc32(study.scenario.encode()))  # their luck, where nobody says whose
    tried = set()
    for streams, job in jobs_of(study, rules, tmp_path):
        if job.func not in tried:
            tried.add(job.func)
            roots.clear()
            job()
            met = {root[:2] for root in roots} | {of_robots}
            assert met == {*((77, zlib.crc32(its.encode())) for its in streams), of_robots}, streams
    assert len(tried) == 8


def run_universes(study, monkeypatch):
    """Some universes, with every replicate: all their seeds differ, and have 32 bits."""
    monkeypatch.setattr(measuring, "_coupling", lambda world: 1.0)
    monkeypatch.setattr(measuring, "width_order", lambda trials: {})  # of numbers that differ
    design = read_design(ROOT / DESIGN)
    assert len({study.seed, *(designed.seed for designed in design)}) == 1 + len(design)
    for designed in design[::16]:
        setup = universe(study, designed)
        for row in measuring.measure(setup), horizon.horizon(setup):
            assert len(row) == setup.replicates


@pytest.mark.slow
@pytest.mark.usefixtures("without_data")
def test_no_test_pose_of_any_job_was_learned_from_or_searched_with(
    study, rules, drawn, tmp_path, monkeypatch
):
    for _, job in jobs_of(study, rules, tmp_path):
        job()
    run_universes(study, monkeypatch)
    tests = np.unique(np.concatenate(drawn.tests[ResultPoses]))
    searched = np.unique(np.concatenate(drawn.tests[SearchPoses]))
    learned = np.unique(np.concatenate(drawn.learned))
    assert min(map(len, (tests, searched, learned))) > 10_000
    for some, others in ((tests, learned), (tests, searched), (searched, learned)):
        near = np.searchsorted(others, some).clip(max=len(others) - 1)
        assert (others[near] != some).all()
