"""Trainings: when they are measured, on which poses, and what is kept of them."""

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from scipy.stats import qmc

from recalib import load
from recalib.numerics import generator
from replication.config import Measuring
from replication.running import write
from replication.training import Stream
from replication.training import train as module
from replication.training.train import train
from tests.conftest import changed
from tests.replication.conftest import ALONE, settings_of

SPARSE = Measuring(tests=2, measure_every=4, measure_evenly=200, measurements=50)


@pytest.mark.parametrize(("iterations", "every"), [(200, 4), (10, 4), (3, 5)])
def test_short_trainings_are_measured_evenly_and_at_their_end(iterations, every):
    grid = SPARSE.model_copy(update={"measure_every": every}).during(iterations)
    assert grid[0] == 0 and grid[-1] == iterations and set(np.diff(grid[:-1])) <= {every}
    grid = SPARSE.during(10_000)
    assert grid[:3] == [0, 1, 2] and grid[-1] == 10_000 and 35 <= len(grid) <= 51


def drawn(runs, iterations, scenario="links", **how):
    return Stream.SCENARIO.draw(1, runs, iterations, 20, scenario=scenario, **how)


def test_compared_learners_see_the_same_poses_and_never_the_tests():
    short, long = drawn(range(3), 20), drawn(range(1, 3), 200)
    assert np.array_equal(short.desired[1:], long.desired[:, :20])
    assert np.array_equal(short.tests[1:], long.tests)
    assert not np.isclose(short.tests, short.desired).any()
    others = drawn(range(3), 20, scenario="encoders")
    assert not np.isclose(short.desired, others.desired).any()
    assert not np.isclose(short.desired[0], short.desired[1]).any()


def test_poses_are_independent_by_default_or_spread_evenly():
    same = generator(1, "links", 2, "desired").uniform(-1, 1, (20, 6))
    assert np.array_equal(drawn([2], 20).desired[0], same)
    short, long = (drawn([2, 3], n, order="even").desired for n in (20, 200))
    assert np.array_equal(short, long[:, :20])
    assert not np.isclose(long[0], long[1]).any()
    assert -1 < long.min() < -0.98 < 0.98 < long.max() < 1
    random = drawn([2, 3], 200).desired
    for one, other in zip(long, random, strict=True):
        assert qmc.discrepancy((one + 1) / 2) < 0.2 * qmc.discrepancy((other + 1) / 2)


@pytest.fixture(scope="module")
def small(study):
    plan = {"scenarios": ("links",), "learners": {"improved": (6, 9)}} | ALONE
    return changed(study, experiments=plan, training={"seeds": 2, "tests": 5, "measure_every": 4})


@pytest.fixture
def job(small, plan, tmp_path):
    """The arguments of a job, and the files that it writes."""
    write(resolved := tmp_path / "links.json", plan.resolved("links"))
    files = [tmp_path / "improved.parquet"], [tmp_path / "improved.npz"]
    settings = settings_of(small, tmp_path / "outcomes.csv")
    return (small, "ur10", "links", resolved, settings, *files), *files


def test_a_history_has_all_lengths_and_the_archive_the_learner_of_the_shortest(job, robot):
    arguments, (history,), (learned,) = job
    train(*arguments)
    table = pd.read_parquet(history)
    measured = table.groupby(["iterations", "seed"])["iteration"].agg(list).to_dict()
    short, long = [0, 4, 6], [0, 4, 8, 9]
    assert measured == {(6, 0): short, (6, 1): short, (9, 0): long, (9, 1): long}
    last = table[table["iteration"] == table["iterations"]]
    assert (last["moves"] == 2 * last["iterations"]).all()
    before = table[table["iteration"] == 0].groupby("seed")["position_error_cm"]
    assert (before.nunique() == 1).all(), "both begin on the same poses"
    commands = load(learned, robot).command(np.zeros((2, 1, 6)))
    assert commands.shape == (2, 1, 6) and np.abs(commands).min() > 0


def test_moves_that_the_controller_refused_by_the_end_are_told(job, monkeypatch, capsys):
    columns = {"run": np.arange(2), "iteration": np.full(2, 4)}
    history = SimpleNamespace(refused=np.array([[0, 0, 2], [0, 1, 1]]), columns=columns.copy)
    monkeypatch.setattr(module, "train_for_results", lambda *_: history)
    train(*job[0])
    message = capsys.readouterr().err
    assert "improved, 6 iterations, on links: the controller refused 3 moves" in message
