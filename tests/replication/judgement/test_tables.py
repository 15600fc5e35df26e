"""Tables of the benchmark and of the real arm, beside what one computes by hand."""

import numpy as np
import pandas as pd
import pytest

from replication.judgement.benchmark import errors, moves_to_reach, reached
from replication.judgement.effects import effects
from replication.training.measured import ERRORS
from replication.pages.guidance import moves_text
from replication.pages.real_arm import ERROR, real_errors

SEEDS = 21
SCENARIOS, LEARNERS = ("sag", "noise"), ("hybrid", "improved")


@pytest.fixture(scope="module")
def history() -> pd.DataFrame:
    """Seed s of the hybrid gets below 1 cm after 2 + 2 s moves, of the map never; and others."""
    rows = []
    for scenario in ("noise", "sag", "gears"):
        for learner in ("improved", "hybrid"):
            for seed in range(SEEDS):
                for moves in range(2, 62, 2):
                    within = learner == "hybrid" and moves >= 2 + 2 * seed
                    its = dict(zip(ERRORS, (0.5 if within else 2 + seed, 5.0), strict=True))
                    about = {"scenario": scenario, "learner": learner, "seed": seed, "moves": moves}
                    rows.append(about | its)
    return pd.DataFrame(rows).sample(frac=1, random_state=0)


def test_errors_are_means_over_seeds_at_each_budget(history):
    table = errors(history, SCENARIOS, LEARNERS, seed=7)
    assert len(table) == 2 * 2 * 30
    keys = table[["scenario", "learner"]].drop_duplicates().to_numpy().tolist()
    assert keys == [[one, other] for one in SCENARIOS for other in LEARNERS]
    row = table[(table["learner"] == "improved") & (table["moves"] == 10)].iloc[0]
    assert row["seeds"] == SEEDS and row[ERRORS[0]] == 12 and row[ERRORS[1]] == 5
    assert 12 - 3.2 < row[f"{ERRORS[0]}_low"] < 12 - 1.5
    assert 12 + 1.5 < row[f"{ERRORS[0]}_high"] < 12 + 3.2
    assert row[f"{ERRORS[1]}_low"] == row[f"{ERRORS[1]}_high"] == 5


def test_moves_to_a_threshold_are_a_median_between_the_5th_and_the_95th_percentile(history):
    table = reached(history, SCENARIOS, LEARNERS, (1.0, 0.1))
    assert len(table) == 2 * 2 * 3 * 2
    by = table.set_index(["scenario", "learner", "error", "threshold"])
    row = by.loc[("sag", "hybrid", ERRORS[0], 1.0)]
    assert [row["low"], row["moves"], row["high"]] == [4, 22, 40]
    assert row["needs"] == "measured poses, nominal kinematics"
    assert np.isinf(by.loc[("sag", "hybrid", ERRORS[0], 0.1), "moves"])
    assert np.isinf(by.loc[("noise", "improved", ERRORS[0], 1.0), "low"])
    assert by.loc[("noise", "improved", ERRORS[0], 1.0), "needs"].endswith("two moves for each")


@pytest.mark.parametrize(
    ("moves", "low", "high", "text"),
    [
        (1234, 900, 5678, "1,234 (900 to 5,678)"),
        (7, 2, np.inf, "7 (2 to more)"),
        (3, 3, 3, "3"),
        (np.inf, 2, np.inf, "-"),
    ],
)
def test_moves_are_said_with_their_spread(moves, low, high, text):
    assert moves_text(pd.Series({"moves": moves, "low": low, "high": high})) == text


def test_both_errors_have_to_be_within_a_threshold_at_once():
    """The medians of each error by itself would hide a seed that is slow in the other."""
    rows = [(0, 1, 0.5, 2), (0, 2, 2, 0.5), (0, 3, 0.5, 0.5), (1, 1, 0.5, 0.5), (1, 2, 2, 2)]
    history = pd.DataFrame(rows, columns=["seed", "moves", *ERRORS])
    assert moves_to_reach(history, ERRORS[:1], 1.0).tolist() == [1, 1]
    assert moves_to_reach(history, ERRORS, 1.0).tolist() == [3, 1]


def test_errors_on_the_real_arm_are_means_over_subsets(roots):
    runs = pd.DataFrame({"learner": ["b"] * 4 + ["a"] * 3, "poses": [5, 5, 5, 10, 5, 5, 5]})
    runs[ERROR] = [1.0, 2, 6, 4, 7, 8, 9]
    table = real_errors(runs, seed=1)
    assert table[["learner", "poses", "subsets"]].to_numpy().tolist() == [
        ["b", 5, 3],
        ["b", 10, 1],
        ["a", 5, 3],
    ]
    assert table[ERROR].tolist() == [3, 4, 8]
    assert len({*roots}) == len(table), "each with random numbers of its own"
    assert np.isnan(table[f"{ERROR}_low"][1]) and 7 <= table[f"{ERROR}_low"][2] < 8


def test_an_effect_is_the_difference_of_means_with_an_interval_and_a_bar_of_chance():
    random = np.random.default_rng(1)
    levels = np.repeat(["low", "high"], 100)
    luck = 0.2 * random.normal(size=200)
    numbers = luck + np.where(levels == "high", np.log(1.5), 0)
    design = pd.DataFrame({"it": levels, "other": random.permutation(levels)})
    table = effects(numbers, design, random)
    row, noise = table.iloc[0], table.iloc[1]
    assert (row["factor"], row["least"], row["largest"]) == ("it", "low", "high")
    means = [numbers[levels == level].mean() for level in ("high", "low")]
    assert row["effect"] == pytest.approx(np.subtract(*means))
    spread = np.sqrt(2 * luck.var() / 100)
    bounds = [row["effect"] - row["low"], row["high"] - row["effect"]]
    assert bounds == pytest.approx([1.96 * spread] * 2, rel=0.12)
    # of the absolute difference when the labels are shuffled: two sides, and two factors
    assert row["chance"] == pytest.approx(2.24 * np.sqrt(numbers.var() / 50), rel=0.12)
    assert noise["effect"] < noise["chance"]
