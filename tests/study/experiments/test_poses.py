"""What settings are chosen by, no result is measured on: neither by a slip nor in any job."""

import numpy as np
import pandas as pd
import pytest

from recalib.damaged.disturbances import Noise
from recalib.study.configuration.damages import Assigned
from recalib.study.experiments import benchmark, campaign, ensemble, real_arm, trials
from recalib.study.experiments import poses as its
from recalib.study.experiments.poses import (
    ResultPoses,
    SearchPoses,
    Stream,
    Use,
    train_for_results,
)
from recalib.study.experiments.trials import Search, search_for
from recalib.study.layout import DESIGN, SEARCHED
from recalib.study.multiverse import efforts, horizon, measuring
from recalib.study.multiverse.design import read_design
from recalib.study.multiverse.universe import universe
from recalib.study.plants import resolve
from recalib.study.trainings import Trainings, training
from recalib.training import History
from tests.conftest import ROOT
from tests.test_architecture import imported

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
    desired = for_results().desired
    with pytest.raises(ValueError, match="links: test poses are among those to learn from"):
        kind("links", desired, desired[:, ::-1])


@pytest.mark.parametrize("names", [Use, Stream])
def test_no_two_purposes_share_a_name(names):
    """Python makes the second of two equal names another word for the first."""
    assert len(names.__members__) == len([*names])


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
    train = {path.stem for path in modules if "recalib.training.train" in imported(path)}
    assert train == {"poses"}


def test_a_search_meets_none_of_the_noise_that_results_meet(plan, tmp_path, monkeypatch):
    """Settings that suit one noise would be measured with it again."""
    met = []

    def train(plant, learner, desired, tests, measure_at, **how):
        moves = plant.execute(np.zeros((len(desired), 4, 6))).achieved
        met.append(moves.reshape(-1, 6))
        return nothing_learned(desired, measure_at)

    monkeypatch.setattr(its, "train", train)
    noise = {"name": "noise", "damages": (Noise(1e-3, 1e-3),)}
    resolve(plan.scenario("noise").model_copy(update=noise)).write(tmp_path / "noise.json")
    search, training_ = plan.search("improved_200", 0), plan.training("noise", "improved", 0)
    less = {"rounds": 1, "trials": 2}
    update = {"budget": search.budget.model_copy(update=less), "last": 2}
    search_for(search.model_copy(update=update), tmp_path / "noise.json")
    sample = ROOT / SEARCHED / "improved_200.csv"
    campaign.train_seeds(training_, tmp_path / "noise.json", sample)
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


def run_all_jobs(study, plan, folder, monkeypatch):
    """All jobs of a study that learn."""

    def sample(name):
        return ROOT / SEARCHED / f"{training(study, name)}.csv"

    def resolved(name):
        path = folder / f"{name}.json"
        if not path.exists():
            job = plan.scenario(name)
            there = any(isinstance(entry, Assigned) for entry in job.damages)
            resolve(job.model_copy(update={"damages": ()} if there else {})).write(path)
        return path

    own, trainings = study.scenario, Trainings(study)
    for scenario, learner in trainings.runs:
        for chunk in plan.training_chunks(learner):
            job = plan.training(scenario, learner, chunk)
            campaign.train_seeds(job, resolved(scenario), sample(learner))
    longest = trainings.tuned()[0]  # the others see the first of its poses
    efforts.efforts(plan.efforts(longest), resolved(own), sample(longest))
    for name in trainings.tuned():
        for chunk in plan.search_chunks(name):
            search_for(plan.search(name, chunk), resolved(own))
    for learner, series in study.experiments.ensemble.items():
        for name in series:
            for chunk in plan.draw_chunks(name, learner):
                ensemble.train_draws(plan.draws(name, learner, chunk), sample(learner))
    for learner in study.benchmark.learners:
        for batch, scenarios in plan.batches().items():
            job = plan.benchmark(learner, batch)
            benchmark.compete(job, [*map(resolved, scenarios)], job.learner and sample(learner))
    said = type("Said", (), {"target": np.eye(4)})
    monkeypatch.setattr(real_arm, "read_whole_description", lambda _: said)
    for name in ("read_of", "calibrate_hybrid", "Plant"):
        monkeypatch.setattr(real_arm, name, lambda *_: None)
    for name in study.real.twin:
        real_arm.learn_on_twin(plan.real_twin(name), "", "", sample(name))


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
    study, plan, drawn, tmp_path, monkeypatch
):
    run_all_jobs(study, plan, tmp_path, monkeypatch)
    run_universes(study, monkeypatch)
    tests = np.unique(np.concatenate(drawn.tests[ResultPoses]))
    searched = np.unique(np.concatenate(drawn.tests[SearchPoses]))
    learned = np.unique(np.concatenate(drawn.learned))
    assert min(map(len, (tests, searched, learned))) > 10_000
    for some, others in ((tests, learned), (tests, searched), (searched, learned)):
        near = np.searchsorted(others, some).clip(max=len(others) - 1)
        assert (others[near] != some).all()
