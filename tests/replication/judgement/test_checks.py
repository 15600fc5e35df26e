"""The summary of a study, and the check of its final errors."""

import numpy as np
import pandas as pd
import pytest
from scipy.stats import t as student

from recalib import RecalibError
from replication.judgement import cells_of_mean, check, expect, propose, report, summarise
from replication.running import BANDS, write
from replication.training import ERRORS, places
from tests.conftest import changed
from tests.replication.conftest import ALONE

KEYS = {"robot": "ur10", "learner": "improved", "iterations": 200}
SUMMARY = pd.DataFrame(
    [
        KEYS
        | {"scenario": scenario}
        | {
            f"final_{error}{end}": value * by
            for error, value in zip(ERRORS, errors, strict=True)
            for end, by in (("", 1), ("_low", 0.96), ("_high", 1.05))
        }
        for scenario, errors in (("links", (0.25, 0.2)), ("intact", (1e-10, 1e-10)))
    ]
)


def test_an_interval_of_a_mean_is_students_and_stays_above_zero():
    values = 5 + np.random.default_rng(1).normal(size=20) / 20
    cells = cells_of_mean("error", values)
    assert [*cells] == ["error", "error_low", "error_high"]
    half = student.ppf(0.975, 19) * values.std(ddof=1) / np.sqrt(20)
    expected = values.mean() + half * np.array([0, -1, 1])
    assert [*cells.values()] == pytest.approx(expected, rel=1e-4)
    assert cells_of_mean("error", np.array([1e-3, 1.0]))["error_low"] > 0
    assert [*cells_of_mean("error", np.zeros(3)).values()] == [0, 0, 0]
    assert np.isnan(cells_of_mean("error", np.ones(1))["error_low"])


def test_intervals_hold_the_mean_as_often_as_they_say():
    rng, covered = np.random.default_rng(3), 0
    for _ in range(400):
        _, low, high = cells_of_mean("error", np.exp(0.3 * rng.normal(size=20))).values()
        covered += low <= np.exp(0.045) <= high
    assert 0.92 <= covered / 400 <= 0.98


def test_a_summary_has_a_row_for_each_place_learner_and_length(study, tmp_path):
    plan = {"scenarios": ("links",), "learners": {"improved": (10, 20)}}
    small, paths = changed(study, experiments=plan | ALONE | {"robots": ("z1",)}), []
    for number, learners in enumerate(places(small).values()):
        rows = [
            {"iterations": iterations, "seed": seed, "refused": seed}
            | {"iteration": when, "moves": 2 * when}
            | dict.fromkeys(ERRORS, 1 + number + seed - when / 100)
            for lengths in learners.values()
            for iterations in lengths
            for seed in range(2)
            for when in (0, 4, iterations)
        ]
        paths.append(tmp_path / f"{number}.parquet")
        write(paths[-1], pd.DataFrame(rows))
    table = summarise(small, paths)
    assert table[["robot", "scenario", "learner", "iterations"]].to_numpy().tolist() == [
        [robot, scenario, "improved", iterations]
        for robot, scenario in (("ur10", "links"), ("z1", "links_encoders"))
        for iterations in (10, 20)
    ]
    assert table["seeds"].tolist() == [2] * 4 and table["moves"].tolist() == [20, 40] * 2
    assert table["refused"].tolist() == [1] * 4
    assert table[f"initial_{ERRORS[0]}"].tolist() == [1.5, 1.5, 2.5, 2.5]
    assert table[f"final_{ERRORS[1]}"].tolist() == pytest.approx([1.4, 1.3, 2.4, 2.3])
    assert (table[f"final_{ERRORS[0]}_low"] < table[f"final_{ERRORS[0]}"]).all()


def test_results_pass_their_own_bands_and_changes_and_other_trainings_do_not():
    bands = expect(SUMMARY)
    assert ",".join(bands.columns) == BANDS, "as they are read"
    assert check(SUMMARY, bands)["ok"].all()
    for column, value in (("final_position_error_cm", 0.30), ("final_orientation_error_deg", 0.15)):
        table = check(SUMMARY.assign(**{column: value}), bands)
        rows = (table["scenario"] == "links") & (table["error"] == column[6:])
        assert not table[rows]["ok"].any()
        assert table[~rows & (table["scenario"] == "links")]["ok"].all()
    table = check(SUMMARY.assign(final_position_error_cm=np.nan), bands)
    assert table["ok"].sum() == 2
    assert not check(SUMMARY, bands[bands["scenario"] == "links"])["ok"].all()
    assert not check(SUMMARY[:1], bands)["ok"].all()
    assert not check(SUMMARY.assign(iterations=500), bands)["ok"].any(), "of another length"
    assert not check(SUMMARY.assign(robot="ur5"), bands)["ok"].any(), "of another robot"


def test_a_band_reaches_twice_as_far_as_the_interval():
    bands = expect(SUMMARY)
    assert bands.iloc[0][["low", "high"]].tolist() == pytest.approx(
        [0.25 * 0.96**2, 0.25 * 1.05**2]
    )
    intact = bands[bands["scenario"] == "intact"]
    assert intact[["low", "high"]].to_numpy().tolist() == [[0.0, 1e-3]] * 2
    table = check(SUMMARY.assign(final_position_error_cm=[0.25, 2e-3]), bands)
    assert table.loc[~table["ok"], ["scenario", "error"]].to_numpy().tolist() == [
        ["intact", "position_error_cm"]
    ]


def test_a_failure_names_the_training_the_value_and_the_band(tmp_path):
    write(summary := tmp_path / "summary.csv", SUMMARY)
    write(bands := tmp_path / "bands.csv", propose(summary))
    assert "0.25" in report(summary, bands)
    write(summary, SUMMARY.assign(final_position_error_cm=[7.0, 0]))
    message = (
        "1 of 4 final errors are outside their bands\nimproved, 200 iterations, on the ur10,"
        " links: position_error_cm is 7, expected 0.2304 to 0.2756"
    )
    with pytest.raises(RecalibError, match=message):
        report(summary, bands)
