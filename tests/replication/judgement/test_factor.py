"""The factor of 70, asked in twelve ways, where what each would find is known."""

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from replication.config import shipped
from replication.judgement.factor import (
    ANEW,
    EFFORTS,
    factor_table,
    in_words,
    on_the_way,
    watched,
)
from replication.judgement.factor_in_setups import in_setups
from replication.judgement.intervals import Estimate
from replication.training.measured import ERRORS
from replication.judgement.verdicts import Verdict
from tests.synthetic import Synthetic

NEEDS = f"runs/{{scenario}}/{{ladder}}.parquet {shipped.EFFORTS} iterations seed"


@pytest.fixture(scope="module")
def table(few, tmp_path_factory):
    synthetic = Synthetic(tmp_path_factory.mktemp("factor"), few)
    rows = factor_table(synthetic.evidence(NEEDS))
    return {(row["cells"], row["effort"], row["definition"]): row for row in rows}


def test_there_are_twelve_and_the_papers_own_reading_leads(table):
    full, _, papers = EFFORTS
    assert len(table) == 12 and next(iter(table)) == ("both maps together", full, ANEW)
    assert EFFORTS[papers] == ("rough", "full")


def test_each_is_what_was_made_up(table):
    """Errors fall by the iterations, and a rough search leaves half as much again."""
    for (cells, effort, definition), row in table.items():
        fast, slow = EFFORTS[effort]
        expected = 70 / (1.5 if fast == "rough" else 1) * (1.5 if slow == "rough" else 1)
        # on the way there are ten measurements, and the next one counts
        off = 0.05 if definition == ANEW else 0.16
        assert row["factor"].mean == pytest.approx(expected, rel=off), (effort, definition)
        assert row["factor"].low <= row["factor"].mean <= row["factor"].high
        # Ritter's with full effort gets there in 10,000 iterations, and counts what it is asked
        whole = 50 if (fast, slow) == ("rough", "full") else 100
        tried = 200 if cells == "both maps together" else 100
        assert row["longest"] == (tried if definition == ANEW else whole)
        assert row["verdict"] == in_words(row["factor"])


def test_a_contradiction_says_on_which_side_the_factor_is():
    assert in_words(Estimate(40, 30, 50)) == f"{Verdict.CONTRADICTED}: the factor is smaller"
    assert in_words(Estimate(90, 80, np.inf)) == f"{Verdict.CONTRADICTED}: the factor is larger"
    assert in_words(Estimate(70, 60, 80)) == Verdict.SUPPORTED


def rising(iterations, ends):
    """When it is measured, and errors (4 searches, 3 seeds, measurement, 2) that fall to an end."""
    grid = np.linspace(0.1, 1, 10) * iterations
    errors = ends * iterations / grid[None, None, :, None] * np.ones((4, 3, 1, 2))
    return grid, errors


@pytest.mark.parametrize(
    ("ends", "longest", "factor"),
    [
        ({10_000: 0.5, 20_000: 0.1}, 10_000, 25.0),  # the shortest that gets there
        ({10_000: 2.0, 20_000: 0.5}, 20_000, 50.0),
        ({5_000: 0.1, 10_000: 2.0, 20_000: 1.0}, 20_000, 100.0),  # no short training counts
        ({10_000: 3.0, 20_000: 2.0}, 20_000, np.inf),  # nobody gets there
    ],
)
def test_on_the_way_the_shortest_long_training_that_gets_there_counts(ends, longest, factor):
    slow = {iterations: rising(iterations, end) for iterations, end in ends.items()}
    found = on_the_way(slow, np.ones((4, 3, 2)), 200, np.random.default_rng(0))
    assert found[0] == longest
    assert found[1] == pytest.approx((factor,) * 3)


def test_both_errors_have_to_be_reached():
    grid, errors = rising(10_000, 0.5)
    errors[..., 1] *= 1.5
    rng, goal = np.random.default_rng(0), np.ones((4, 3, 2))
    _, found = on_the_way({10_000: (grid, errors)}, goal, 200, rng)
    assert found.mean == 40


def of_efforts() -> pd.DataFrame:
    """Two full searches with two rough ones each, two seeds and two measurements."""
    rows = [
        {"training": f"{learner}_{n}", "effort": effort, "iterations": n}
        | {"search": search, "seed": seed, "iteration": n // part}
        | dict.fromkeys(ERRORS, 1000 * (effort == "rough") + 100 * search + 10 * seed + 1 / part)
        for learner, n in (("ritter", 20), ("ritter", 10), ("ritter_double", 10))
        for effort, searches in (("full", 2), ("rough", 4))
        for search in range(searches)
        for seed in range(2)
        for part in (2, 1)
    ]
    return pd.DataFrame(rows).sample(frac=1, random_state=0)


def test_rough_searches_count_as_seeds_of_the_full_one_that_holds_them():
    full, its = (watched(of_efforts(), "ritter", each)[20][1] for each in ("full", "rough"))
    assert full.shape == (2, 2, 2, 2) and its.shape == (2, 4, 2, 2)
    assert full[1, 1, :, 0].tolist() == [110.5, 111]
    assert its[0, :, -1, 0].tolist() == [1001, 1011, 1101, 1111]
    assert its[1, :, -1, 0].tolist() == [1201, 1211, 1301, 1311]


def test_trainings_of_one_learner_are_no_trainings_of_another():
    ours, doubled = (watched(of_efforts(), name, "full") for name in ("ritter", "ritter_double"))
    assert {n: grid.tolist() for n, (grid, _) in ours.items()} == {10: [5, 10], 20: [10, 20]}
    assert [*doubled] == [10]


def test_in_setups_it_stands_by_cells_and_those_with_a_bound_are_left_out():
    """Twice as large with the cells of both maps; one setup's is not known."""
    setups, random = np.arange(24), np.random.default_rng(0)
    whole, moved = setups % 2 == 0, setups % 4 < 2
    design = pd.DataFrame(
        {
            "cells": np.where(whole, "whole", "each"),
            "effort": "full",
            "displacement": np.where(moved, "random", "configured"),
        }
    )
    factors = np.repeat(np.where(whole, 80.0, 40.0), 2) * np.exp(random.normal(0, 0.1, 48))
    table = pd.DataFrame({"universe": np.repeat(setups, 2), "replicate": np.tile([0, 1], 24)})
    table = table.assign(factor=factors, bound=0)
    table.loc[5, ["factor", "bound"]] = 200, 1
    evidence = SimpleNamespace(
        setups={"horizon": table}.get,
        levels=lambda: design,
        rng=lambda *words: np.random.default_rng(1),
    )
    found = in_setups(evidence)
    larger, smaller = found["rows"]
    assert (larger["cells"], smaller["cells"]) == ("both maps together", "one map")
    assert larger["factor"].mean == pytest.approx(80, rel=0.05)
    assert smaller["factor"].mean == pytest.approx(40, rel=0.05)
    assert (larger["left_out"], larger["setups"]) == (1, 11)
    assert (smaller["left_out"], smaller["setups"]) == (0, 12)
    assert smaller["verdict"] == in_words(smaller["factor"])
    known = np.exp(np.log(factors).reshape(24, 2).mean(axis=1)[setups != 2])
    assert found["at_the_end"].mean > np.exp(np.log(known).mean())
    assert found["control"].mean < found["chance"]
    table.loc[table["universe"] % 2 == 0, "bound"] = 1
    unknown, known = in_setups(evidence)["rows"]
    assert (unknown["setups"], unknown["left_out"], unknown["verdict"]) == (0, 12, "undecided")
    assert np.isnan(unknown["factor"].mean) and known == smaller
    table["bound"] = 1
    assert in_setups(evidence) == {}


def test_where_no_setup_is_measured_nothing_is_said_of_them():
    assert in_setups(SimpleNamespace(setups={}.get)) == {}
