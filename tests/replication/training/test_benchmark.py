import numpy as np
import pandas as pd
import pytest

from recalib.loop.interfaces import Outcome
from replication.judgement.benchmark import moves_to_reach
from replication.training.measured import ERRORS
from replication.pages.guidance import where_worse
from replication.training.benchmark import Timed, compete, measured_at
from workflow.scripts.call import write


def test_a_map_is_measured_where_its_moves_meet_a_budget():
    assert measured_at([1, 2, 3, 4, 400, 1000], iterations=200, moves=2) == [1, 2, 200]
    assert measured_at([1, 2, 3, 500], iterations=400, moves=1) == [1, 2, 3]


def test_scenarios_side_by_side_are_what_each_of_them_is_alone(plan, tmp_path):
    paths = []
    for name in ("links", "rotation"):
        paths.append(tmp_path / f"{name}.json")
        write(paths[-1], plan.resolved(name))

    def competed(*scenarios):
        return compete([*scenarios], "affine", None, 2, (2, 4), (8, 3), tests=3, seed=1)

    both = competed(*paths).drop(columns="seconds_per_move")
    assert both.groupby(["scenario", "seed"])["moves"].agg(list).to_dict() == {
        (name, seed): [2, 3, 4] for name in ("links", "rotation") for seed in (0, 1)
    }
    for path in paths:
        alone = competed(path).drop(columns="seconds_per_move")
        beside = both[both["scenario"] == path.stem].reset_index(drop=True)
        pd.testing.assert_frame_equal(beside, alone, rtol=1e-6)


def test_its_time_is_shared_by_all_moves_of_all_runs(plan, tmp_path, monkeypatch):
    def learn(self, *_):
        self.seconds += 6.0

    monkeypatch.setattr(Timed, "learn", learn)
    write(path := tmp_path / "links.json", plan.resolved("links"))
    table = compete([path], "affine", None, 2, (2, 4), (), tests=3, seed=1)
    assert set(table["seconds_per_move"]) == {4 * 6.0 / (2 * 4)}


def test_only_the_time_of_the_learner_is_taken():
    class Slow:
        def command(self, desired):
            return desired

        def learn(self, desired, execute, fraction):
            execute(desired[:, None])

    clock = iter(
        [0.0, 1.0, 11.0, 13.0]
    )  # learning from 0 to 13 s, of which the robot moves from 1 to 11 s
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("replication.training.benchmark.time.perf_counter", lambda: next(clock))
        timed = Timed(Slow())
        timed.learn(
            np.zeros((1, 6)), lambda commands: Outcome(commands, np.ones((1, 1), bool)), 0.0
        )
    assert timed.seconds == 3.0


def test_the_first_measurement_within_a_threshold_counts_for_each_seed():
    errors = {2: [3, 1, 0.5], 0: [3, 3, 3], 1: [1, 4, 0]}  # a row of measurements by seed
    table = [
        {"seed": seed, "moves": moves, ERRORS[0]: error}
        for seed, each in errors.items()
        for moves, error in zip((2, 4, 8), each, strict=True)
    ]
    assert moves_to_reach(pd.DataFrame(table), (ERRORS[0],), 1).tolist() == [np.inf, 2, 4]


def test_where_the_hybrid_is_worse_than_the_best_peer_is_said_unless_it_is_by_rounding():
    tiny = {"hybrid": 9e-5, "gaussian_process": 1e-9, "affine": 1e-9}
    rows = [
        {"scenario": "links", "learner": learner, "moves": moves}
        | {ERRORS[0]: value, ERRORS[1]: tiny[learner]}
        for moves, values in ((2, (9, 1, 5)), (4, (1.05, 1, 5)), (8, (1.2, 1, 5)), (16, (9, 1, 5)))
        for learner, value in zip(("hybrid", "gaussian_process", "affine"), values, strict=True)
    ]
    rows += [row | {"learner": "improved", ERRORS[0]: 0.1} for row in rows[:3]]  # is no peer
    assert where_worse(pd.DataFrame(rows), [2, 4, 8]) == [
        {
            "scenario": "links",
            "moves": 8,
            "error": "position",
            "hybrid": 1.2,
            "best": 1,
            "learner": "Gaussian process",
        }
    ]
