"""What settings are chosen by, no result is measured on: neither by a slip nor in any job."""

import zlib

import numpy as np
import pandas as pd
import pytest

from recalib.damaged.disturbances import Noise
from recalib.loop.training import History
from recalib.study.configuration.damages import Assigned
from recalib.study.configuration.shipped import DESIGN, SEARCHED
from recalib.study.experiments import benchmark, campaign, ensemble, real_arm, replay, trials
from recalib.study.experiments import poses as its
from recalib.study.experiments.poses import (
    ResultPoses,
    SearchPoses,
    Stream,
    train_for_results,
)
from recalib.study.experiments.trials import Search, search_for
from recalib.study.multiverse import efforts, horizon, measuring
from recalib.study.multiverse.design import read_design
from recalib.study.multiverse.universe import universe
from recalib.study.plan.chunks import chunks, searches_per_job
from recalib.study.plan.trainings import Trainings, searches, seeds, training
from recalib.study.scenarios.plants import resolve
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
    with pytest.raises(TypeError, match="ResultPoses expected, SearchPoses found: search 1 for"):
        ResultPoses.side_by_side([for_results(), for_a_search()])


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


def test_every_job_draws_by_the_seed_that_it_is_told_from_its_own_stream(
    study, rules, drawn, roots, tmp_path, monkeypatch
):
    """The root of all randomness of a job, (seed, first key): nothing else, of nobody else."""
    own = study.scenario

    def job(rule, **which):
        return rules.arguments(study, rule, **which) | {"seed": 77}

    sample, scenario = ROOT / SEARCHED / "improved_200.csv", tmp_path / f"{own}.json"
    write(scenario, resolve(**rules.arguments(study, "scenario", scenario=own) | {"damages": ()}))
    without_data(monkeypatch)
    search = rules.arguments(study, "search", training="improved_200", chunk=0) | {"last": 1}
    search["budget"] = search["budget"].model_copy(update={"seed": 77})
    short = {"rules": job("study_replay")["rules"].model_copy(update={"iterations": 1})}
    train = job("train", scenario=own, learner="improved", chunk=0)
    draws = job("ensemble_chunk", series="scaled", learner="improved", chunk=0)
    twin = job("real_twin", learner="improved") | {"poses": (2, 4, 400, 402), "subsets": 2}
    twin["rules"] = twin["rules"].model_copy(update={"iterations": 200})
    jobs = {
        own: lambda: campaign.train_seeds(scenario, sample, tmp_path / "learned.npz", **train),
        "efforts": lambda: efforts.efforts(
            scenario, sample, **job("efforts_of", training="improved_200")
        ),
        f"search 1 for improved_200 on {own}": lambda: search_for(scenario, **search),
        "ensemble": lambda: later(ensemble.train_draws(sample, **draws | {"first": 3, "last": 5})),
        "twin": lambda: on_twin(real_arm.learn_on_twin("", "", sample, **twin)),
        "replay": lambda: replay.replay(scenario, sample, **job("study_replay") | short),
    }

    def on_twin(table):
        """Two moves an iteration; nobody is measured after a training has ended."""
        assert len(table) == 3 * twin["subsets"]

    def later(robots):
        """The runs are the robots, and each has its own poses."""
        assert sorted({*robots["robot"]}) == [3, 4]

    for stream, run in jobs.items():
        roots.clear()
        run()
        of_robots = (77, zlib.crc32(own.encode()))  # their luck, where a job does not say whose
        met = {root[:2] for root in roots} | {of_robots}
        assert met == {(77, zlib.crc32(stream.encode())), of_robots}, stream


def without_data(monkeypatch):
    """A twin of no arm: its poses are drawn all the same."""
    said = type("Said", (), {"target": np.eye(4)})
    monkeypatch.setattr(real_arm, "read_whole_description", lambda _: said)
    for name in ("read_of", "identified", "Plant"):
        monkeypatch.setattr(real_arm, name, lambda *_: None)


def run_all_jobs(study, rules, folder, monkeypatch):
    """All jobs of a study that learn."""

    def sample(name):
        return ROOT / SEARCHED / f"{training(study, name)}.csv"

    def resolved(name):
        path = folder / f"{name}.json"
        if not path.exists():
            job = rules.arguments(study, "scenario", scenario=name)
            there = any(isinstance(entry, Assigned) for entry in job["damages"])
            write(path, resolve(**job | ({"damages": ()} if there else {})))
        return path

    own, trainings = study.scenario, Trainings(study)
    for scenario, learner in trainings.runs:
        for chunk in chunks(seeds(study, learner), study.training.seeds_per_job):
            which = {"scenario": scenario, "learner": learner, "chunk": chunk}
            job, learned = rules.arguments(study, "train", **which), folder / "learned.npz"
            campaign.train_seeds(resolved(scenario), sample(learner), learned, **job)
    longest = trainings.tuned()[0]  # the others see the first of its poses
    job = rules.arguments(study, "efforts_of", training=longest)
    efforts.efforts(resolved(own), sample(longest), **job)
    for name in trainings.tuned():
        for chunk in chunks(searches(study, name), searches_per_job(study, name)):
            job = rules.arguments(study, "search", training=name, chunk=chunk)
            search_for(resolved(own), **job)
    for learner, series in study.experiments.ensemble.items():
        for name, robots in series.items():
            for chunk in chunks(robots.draws, study.experiments.draws_per_job):
                which = {"series": name, "learner": learner, "chunk": chunk}
                job = rules.arguments(study, "ensemble_chunk", **which)
                ensemble.train_draws(sample(learner), **job)
    for learner in study.benchmark.learners:
        job = rules.arguments(study, "benchmark_run", learner=learner)
        file = job["rules"] and sample(learner)
        benchmark.compete([*map(resolved, study.benchmark.scenarios)], **job, sample=file)
    without_data(monkeypatch)
    for name in study.real.twin:
        job = rules.arguments(study, "real_twin", learner=name)
        real_arm.learn_on_twin("", "", sample(name), **job)


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
def test_no_test_pose_of_any_job_was_learned_from_or_searched_with(
    study, rules, drawn, tmp_path, monkeypatch
):
    run_all_jobs(study, rules, tmp_path, monkeypatch)
    run_universes(study, monkeypatch)
    tests = np.unique(np.concatenate(drawn.tests[ResultPoses]))
    searched = np.unique(np.concatenate(drawn.tests[SearchPoses]))
    learned = np.unique(np.concatenate(drawn.learned))
    assert min(map(len, (tests, searched, learned))) > 10_000
    for some, others in ((tests, learned), (tests, searched), (searched, learned)):
        near = np.searchsorted(others, some).clip(max=len(others) - 1)
        assert (others[near] != some).all()
