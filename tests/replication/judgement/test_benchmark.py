"""Tables of the benchmark and of the real arm, beside what one computes by hand."""

import numpy as np
import pandas as pd
import pytest

from replication.judgement import moves_to_reach, put_together, real_errors
from replication.running import write
from replication.training import ERRORS
from tests.conftest import changed

SEEDS = 21
SCENARIOS, LEARNERS = ("sag", "noise"), ("hybrid", "improved")


@pytest.fixture(scope="module")
def tables(study, tmp_path_factory) -> tuple[pd.DataFrame, ...]:
    """Seed s of the hybrid gets below 1 cm after 2 + 2 s moves, of the map never; and others."""
    folder, paths = tmp_path_factory.mktemp("benchmark"), []
    for learner in ("improved", "hybrid"):
        rows = []
        for scenario in ("noise", "sag", "gears"):
            for seed in range(SEEDS):
                for moves in range(2, 62, 2):
                    within = learner == "hybrid" and moves >= 2 + 2 * seed
                    errors = dict(zip(ERRORS, (0.5 if within else 2 + seed, 5.0), strict=True))
                    keys = {"scenario": scenario, "learner": learner, "seed": seed, "moves": moves}
                    rows.append(keys | errors)
        paths.append(folder / f"{learner}.parquet")
        write(paths[-1], pd.DataFrame(rows).sample(frac=1, random_state=0))
    plan = {"scenarios": SCENARIOS, "learners": LEARNERS[:1], "papers": {"improved": 30}}
    return put_together(changed(study, benchmark=plan | {"thresholds": (1.0, 0.1)}), paths)


def test_errors_are_means_over_seeds_at_each_budget(tables):
    table, _ = tables
    assert len(table) == 2 * 2 * 30
    keys = table[["scenario", "learner"]].drop_duplicates().to_numpy().tolist()
    assert keys == [[one, other] for one in SCENARIOS for other in LEARNERS]
    row = table[(table["learner"] == "improved") & (table["moves"] == 10)].iloc[0]
    assert row["seeds"] == SEEDS and row[ERRORS[0]] == 12 and row[ERRORS[1]] == 5
    # Student's reach of 2.09 standard errors of the numbers from 2 to 22: 2.8
    assert row[f"{ERRORS[0]}_low"] == pytest.approx(12 * np.exp(-2.82 / 12), rel=0.01)
    assert row[f"{ERRORS[0]}_high"] == pytest.approx(12 * np.exp(2.82 / 12), rel=0.01)
    assert row[f"{ERRORS[1]}_low"] == row[f"{ERRORS[1]}_high"] == 5


def test_moves_to_a_threshold_are_a_median_between_the_5th_and_the_95th_percentile(tables):
    _, table = tables
    assert len(table) == 2 * 2 * 3 * 2
    by = table.set_index(["scenario", "learner", "error", "threshold"])
    row = by.loc[("sag", "hybrid", ERRORS[0], 1.0)]
    assert [row["low"], row["moves"], row["high"]] == [4, 22, 40]
    assert np.isinf(by.loc[("sag", "hybrid", ERRORS[0], 0.1), "moves"])
    assert np.isinf(by.loc[("noise", "improved", ERRORS[0], 1.0), "low"])


def test_the_first_measurement_within_a_threshold_counts_for_each_seed():
    errors = {2: [3, 1, 0.5], 0: [3, 3, 3], 1: [1, 4, 0]}  # a row of measurements by seed
    table = [
        {"seed": seed, "moves": moves, ERRORS[0]: error}
        for seed, each in errors.items()
        for moves, error in zip((2, 4, 8), each, strict=True)
    ]
    assert moves_to_reach(pd.DataFrame(table), (ERRORS[0],), 1).tolist() == [np.inf, 2, 4]
    rows = [(0, 1, 0.5, 2), (0, 2, 2, 0.5), (0, 3, 0.5, 0.5), (1, 1, 0.5, 0.5), (1, 2, 2, 2)]
    history = pd.DataFrame(rows, columns=["seed", "moves", *ERRORS])
    assert moves_to_reach(history, ERRORS[:1], 1.0).tolist() == [1, 1]
    assert moves_to_reach(history, ERRORS, 1.0).tolist() == [3, 1]


def test_errors_on_the_real_arm_are_means_over_subsets(tmp_path):
    runs = pd.DataFrame({"learner": ["b"] * 4 + ["a"] * 3, "poses": [5, 5, 5, 10, 5, 5, 5]})
    runs["position_error_mm"] = [1.0, 2, 6, 4, 7, 8, 9]
    write(tmp_path / "b.csv", runs[:4].assign(twin=False))
    write(tmp_path / "a.csv", runs[4:].assign(twin=True))
    table = real_errors([tmp_path / "b.csv", tmp_path / "a.csv"])
    assert table[["learner", "twin", "poses", "subsets"]].to_numpy().tolist() == [
        ["b", False, 5, 3],
        ["b", False, 10, 1],
        ["a", True, 5, 3],
    ]
    assert table["position_error_mm"].tolist() == [3, 4, 8]
    low = table["position_error_mm_low"]
    assert np.isnan(low[1]) and low[2] == pytest.approx(8 * np.exp(-2.484 / 8), rel=1e-3)
