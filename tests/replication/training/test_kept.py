"""What small searches, trainings and comparisons come to is as kept."""

import numpy as np
import pytest

from replication.config.shipped import SEARCHED
from replication.config.study import Measuring
from replication.scenarios.plants import Resolved
from replication.training import speed
from replication.training.benchmark import compete
from replication.training.campaign import train_seeds
from replication.training.ensemble import train_draws
from replication.training.poses import Stream
from replication.training.replay import replay
from replication.training.settings import rules_of
from replication.training.trainings import budget
from replication.training.trials import Search, best_of, search_for
from tests.conftest import ROOT
from tests.kept import plain

SAMPLES = ROOT / SEARCHED


def shortened(study, name: str, iterations: int):
    return study.every_learner[name].model_copy(update={"iterations": iterations})


@pytest.fixture(scope="module")
def small(study):
    """What a small search may spend."""
    return budget(study).model_copy(update={"rounds": 2, "trials": 4, "seeds": 2})


@pytest.mark.parametrize("name", ["improved", "ritter"])
def test_all_trials_of_two_searches(name, study, small, uneven_scenario, data_regression):
    learner = shortened(study, name, 5)
    found = search_for(uneven_scenario, f"{name}_5", learner, small, first=1, last=3, tests=7)
    assert list(found["search"].unique()) == [2, 3]
    data_regression.check(plain(found))


def test_trials_around_another_one(study, small, uneven_scenario, data_regression):
    resolved = Resolved.read(uneven_scenario)
    controller = resolved.controller()
    poses = Stream.SEARCH.draw(3, [0, 1], 4, 5, number=2, training="t", scenario="s")
    its = Search(
        lambda runs: resolved.plant(controller, 3, range(runs)),
        rules_of(study.learners["improved"]),
        small,
        poses,
        fixed={"position/g_k": 0.7},
    )
    first = its.all_rounds()
    again = its.further(best_of(first))
    data_regression.check(plain({"first": first, "again": again}))


@pytest.mark.parametrize("name", ["improved", "ritter"])
@pytest.mark.parametrize("throughout", [True, False])
def test_a_training(name, throughout, study, uneven_scenario, tmp_path, data_regression):
    learned = tmp_path / "learned.npz"
    history = train_seeds(
        uneven_scenario,
        SAMPLES / f"{name}_200.csv",
        learned,
        shortened(study, name, 9),
        seeds=3,
        first=1,
        last=5,
        measuring=Measuring(tests=7, measure_every=2, measure_evenly=10, measurements=4),
        throughout=throughout,
        seed=11,
    )
    data_regression.check(plain({"history": history, "learned": arrays(learned)}))


def arrays(path) -> dict:
    with np.load(path) as file:
        return {name: file[name] for name in file.files if file[name].dtype.kind in "fiub"}


def test_on_other_damages(study, plan, data_regression):
    found = train_draws(
        SAMPLES / "improved_200.csv",
        plan.nominal("ur10"),
        study.paper_damage.shorten,
        study.paper_damage.shift,
        series="others",
        scales=(0.5, 1.5),
        first=1,
        last=4,
        rules=shortened(study, "improved", 6),
        tests=5,
        seed=3,
    )
    data_regression.check(plain(found))


@pytest.mark.parametrize("name", ["affine", "geometric", "improved"])
def test_a_comparison(name, study, uneven_scenario, data_regression):
    ours = name == "improved"
    table = compete(
        [uneven_scenario],
        name,
        shortened(study, name, 8) if ours else None,
        seeds=2,
        moves=(4, 10),
        longer=(16,),
        tests=6,
        seed=5,
        sample=SAMPLES / "improved_200.csv" if ours else None,
    )
    digits = 2 if name == "geometric" else 6  # an optimiser's last digits are its own
    table = table.drop(columns="seconds_per_move").round(digits)
    data_regression.check(plain(table))


def test_a_replay(study, uneven_scenario, data_regression):
    rules = shortened(study, "improved", 6)
    found = replay(uneven_scenario, SAMPLES / "improved_200.csv", rules, seed=4)
    assert (found["difference"] == 0).all()
    data_regression.check(plain(found))


def test_what_is_said_of_speed(uneven_scenario, monkeypatch):
    """With a clock of our own: moves and angles count, not how long they take."""
    for name, value in (("RUNS", 2), ("MOVES", 3), ("REPEATS", 3)):
        monkeypatch.setattr(speed, name, value)
    spent, looped = iter([2.0, 1.0, 9.0, 3.0, 5.0, 1.0]), []

    def timeit(function, number):
        function()
        return next(spent)

    monkeypatch.setattr(speed, "timeit", timeit)
    monkeypatch.setattr(speed, "bare_loop", lambda *its: looped.append(its[-1].shape))
    moves, bare, ratio = speed.measure_speed(uneven_scenario).splitlines()
    assert moves == "moves, 2 runs side by side: 1 a second"
    assert bare.endswith(" a move: 6 a second") and ratio == "ratio, median of 3 pairs: 3.0"
    assert looped == [(6, 6)] * 3
