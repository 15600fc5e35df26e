"""What settings are chosen by, no result is measured on: neither by a slip nor in any job."""

from collections import defaultdict

import numpy as np
import pytest

from recalib import History
from replication.campaign import tune
from replication.mapping import jobs
from replication.training import (
    Place,
    ResultPoses,
    SearchPoses,
    Stream,
    Tuning,
    benchmark,
    ensemble,
    places,
    real_arm,
    train,
    train_for_results,
    write_scenarios,
)
from replication.training import poses as module
from tests.conftest import changed
from tests.replication.conftest import settings_of

WORDS = {"number": 1, "setup": 0, "replicate": 0, "widths": "wide"}


def for_a_search():
    return Stream.SEARCH.draw(1, [0, 1], 4, 3, **WORDS)


def for_results():
    return Stream.SCENARIO.draw(1, [0, 1], 4, 3, scenario="links")


def test_a_search_takes_no_poses_of_results_nor_results_those_of_a_search(study):
    class Its:
        poses = for_results()

    with pytest.raises(TypeError, match="SearchPoses expected, ResultPoses found: links"):
        Tuning([Its()], Its(), study.search)
    with pytest.raises(TypeError, match="ResultPoses expected, SearchPoses found: search 1 in"):
        train_for_results(None, None, for_a_search(), [4])
    with pytest.raises(ValueError, match="SCENARIO: 'search 1 in setup 0, replicate 0' is the"):
        Stream.SCENARIO.draw(1, [0, 1], 4, 3, scenario=for_a_search().name)


@pytest.mark.parametrize("kind", [SearchPoses, ResultPoses])
def test_nobody_is_measured_where_it_learned(kind):
    drawn = for_results()
    drawn.tests[1, 2] = drawn.desired[1, 3]  # a single one of them
    with pytest.raises(ValueError, match="links: test poses are among those to learn from"):
        kind("links", drawn.desired, drawn.tests)


@pytest.mark.parametrize("stream", Stream)
def test_a_stream_is_of_a_search_or_of_results_by_its_name(stream):
    drawn = stream.draw(1, [0], 4, 3, scenario="links", **WORDS)
    assert isinstance(drawn, SearchPoses) == drawn.name.startswith("search ")
    assert isinstance(drawn, ResultPoses) != isinstance(drawn, SearchPoses)


@pytest.fixture(scope="module")
def few(study):
    """A study of all kinds of jobs, each of them small."""
    experiments = {
        "scenarios": ("intact", "links_encoders"),
        "robots": ("z1",),
        "learners": {"improved": (20, 30)},
        "own": {"ritter": (20,)},
        "iterations": 20,
        "switches": False,
    }
    rest = {
        "search": {"trials": 16, "near_trials": 16, "runs": 2, "fresh": 4, "doublings": 0},
        "benchmark": {
            "scenarios": ("links_encoders", "noise"),
            "learners": ("affine",),
            "papers": {"improved": 20},
        },
        "real": {"twin": {"improved": 20}},
        "training": {"seeds": 3, "tests": 20},
        "campaign": {"runs": 4},
        "paper_damage": {"shorten": (0.04,), "shift": (0.07,), "poses": 5},
    }
    rest |= {"experiments": experiments}
    return changed(study, **rest)


class Drawn:
    """All poses that jobs draw, by the name of their stream; nothing is trained."""

    def __init__(self, monkeypatch):
        self.desired, self.tests = defaultdict(list), {SearchPoses: [], ResultPoses: []}
        self.names, self.seeds = set(), set()
        draw = Stream.draw

        def noted(stream, seed, *arguments, **words):
            drawn = draw(stream, seed, *arguments, **words)
            self.names.add(drawn.name)
            self.seeds.add(seed)
            self.desired[type(drawn)].append(drawn.desired[..., 0].ravel())
            self.tests[type(drawn)].append(drawn.tests[..., 0].ravel())
            return drawn

        def nothing_learned(plant, learner, desired, tests, measure_at, **how):
            errors = np.ones((len(desired), len(measure_at), 3))
            moves, refused = np.zeros(len(measure_at), int), np.zeros(errors.shape[:2], int)
            return History(np.array(measure_at), moves, refused, errors, errors)

        monkeypatch.setattr(Stream, "draw", noted)
        monkeypatch.setattr(module, "train", nothing_learned)


@pytest.fixture
def drawn(monkeypatch):
    return Drawn(monkeypatch)


def all_jobs(study, folder, monkeypatch):
    """Run every job of a study that learns."""
    root, settings = str(folder), settings_of(study, folder / "outcomes.csv")
    files = {place: folder / place.scenario_file(root) for place in places(study)}
    write_scenarios(study, [*files.values()])
    own = files[Place(study.robot, study.scenario)]
    for place, learners in places(study).items():
        outputs = [
            [folder / f"{place.scenario}.{name}{ending}" for name in learners]
            for ending in (".parquet", ".npz")
        ]
        train.train(study, *place, files[place], settings, *outputs)
    for learner in ("improved", "ritter"):
        tune(study, learner, own)
    ensemble.train_ensemble(study, settings)
    for learner in ("affine", "improved"):
        benchmark.compete(study, learner, settings)
    jobs.learn(study, own, settings)
    description = type("Description", (), {"target": np.eye(4)})
    monkeypatch.setattr(real_arm, "read_whole_description", lambda _: description)
    for name in ("read_of", "identified", "Plant"):
        monkeypatch.setattr(real_arm, name, lambda *_: None)
    real_arm.learn(study, "improved", *[folder] * 3, settings)


def test_no_test_pose_of_any_job_was_learned_from_or_searched_with(
    few, drawn, tmp_path, monkeypatch
):
    all_jobs(few, tmp_path, monkeypatch)
    assert drawn.names == {
        *("intact", "links_encoders", "noise", "ensemble", "twin", "replay", "constant widths"),
        *(f"search for a rate with {widths} widths" for widths in ("wide", "narrow")),
        *(f"search {number} in setup 0, replicate 0" for number in range(3)),
        "setup 0, replicate 0",
    }
    assert drawn.seeds == {few.seed}, "and from nothing else"
    tests = np.concatenate(drawn.tests[ResultPoses])
    searched = np.concatenate(drawn.tests[SearchPoses])
    learned = np.concatenate([desired for kind in drawn.desired.values() for desired in kind])
    assert min(map(len, map(np.unique, (tests, searched, learned)))) > 500
    for some, others in ((tests, learned), (tests, searched), (searched, learned)):
        assert not np.isin(some, others).any()
