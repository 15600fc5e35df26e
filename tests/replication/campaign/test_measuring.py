"""The campaign's design and table: what is published follows from the study."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from replication.campaign import DOUBLE, TWO_MAPS, Replicate, lengths
from replication.campaign.drawing import draw, rows
from replication.campaign.measuring import measure_variant
from replication.campaign.setups import read_design
from replication.campaign.ship import ship
from replication.campaign.untrained import untrained
from replication.campaign.variants import variants
from replication.config import IMPROVED, read_study
from replication.training import ERRORS, Stream

DESIGN, OUTCOMES = (Path("workflow/campaign", name) for name in ("design.csv", "outcomes.csv"))
KEPT = Path(__file__).with_name("searched.csv")
PUBLISHED = pd.read_csv(OUTCOMES)
STUDY = read_study(Path("config.yaml"), {})
# Searches of each kind, too short to find anything.
SHORT = {
    "experiments": {"iterations": 60},
    "search": {
        "fresh": 4,
        "trials": 32,
        "near_trials": 16,
        "near": 90,
        "runs": 3,
        "long": 60,
        "long_runs": 2,
    },
    "campaign": {"runs": 3, "late": 90, "rungs": [120, 140], "rough": {"trials": 4}},
}
SEARCHED = IMPROVED, DOUBLE, TWO_MAPS, "two_maps_for_position_paper", "improved_rough"


def test_published_setups_are_drawn_again():
    setups = {setup.row: setup for setup in read_design(DESIGN)[::4]}
    drawn = {
        row.number: draw(STUDY, setups[row.number].setup, row)
        for row in rows(STUDY.campaign)
        if row.number in setups
    }
    assert drawn == setups


def test_published_measurements_without_a_learner_are_made_again(tmp_path):
    few = tmp_path / "design.csv"
    pd.read_csv(DESIGN, dtype=str)[1::9].to_csv(few, index=False)
    published = pd.read_csv(DESIGN.with_name("untrained.csv"))[1::9].reset_index(drop=True)
    pd.testing.assert_frame_equal(untrained(STUDY, few), published, rtol=1e-3)


def test_the_table_has_the_rows_of_the_plan():
    """Ritter's larger map goes on until it reaches the improved system's errors."""
    for (setup, name), table in PUBLISHED.groupby(["setup", "variant"]):
        planned = lengths(variants(STUDY)[name], setup)
        measured = table.groupby("replicate")["iterations"].agg(tuple)
        assert set(measured) <= {planned, planned + STUDY.campaign.rungs}
    assert not PUBLISHED.duplicated(["setup", "replicate", "variant", "iterations"]).any()


def test_a_replicate_that_is_measured_again_takes_the_place_of_its_rows(tmp_path):
    table, again = tmp_path / "outcomes.csv", tmp_path / "new" / "3" / "0.csv"
    again.parent.mkdir(parents=True)
    new = PUBLISHED.query("setup == 3 and variant == 'ritter'").assign(trials=1)
    new.to_csv(again, index=False)
    PUBLISHED.to_csv(table, index=False)
    ship(tmp_path / "new", table)
    shipped = pd.read_csv(table)
    mine = shipped["setup"] == 3
    pd.testing.assert_frame_equal(shipped[mine].reset_index(drop=True), new.reset_index(drop=True))
    others = PUBLISHED[PUBLISHED["setup"] != 3].reset_index(drop=True)
    pd.testing.assert_frame_equal(shipped[~mine].reset_index(drop=True), others)


@pytest.mark.parametrize("name", [name for name, its in variants(STUDY).items() if its.lengths])
def test_a_published_row_is_what_its_settings_leave(name):
    """To the last of its four digits; each variant in another setup."""
    variant = variants(STUDY)[name]
    setup = list(variants(STUDY)).index(name) % len(read_design(DESIGN))
    for row in PUBLISHED.query("setup == @setup and variant == @name").to_dict("records"):
        if row["iterations"] > 500:
            continue
        replicate = Replicate(STUDY, read_design(DESIGN)[setup], row["replicate"])
        trials = replicate.trials(variant, row["iterations"], STUDY.campaign.runs, Stream.SETUP)
        left = trials.outcome(np.array([[row[column] for column in trials.space.columns]]))
        means = np.exp(np.log(left.errors[0]).mean(axis=0)) * (100, np.degrees(1))
        assert means == pytest.approx([row[error] for error in ERRORS], rel=1e-3)


def test_short_searches_find_what_they_found(tmp_path):
    """What changes these rows changes those of the campaign: it needs a deviation."""
    study, tables = read_study(Path("config.yaml"), SHORT), []
    for name in SEARCHED:
        tables.append(measure_variant(study, DESIGN, 2, 1, name, [*tmp_path.iterdir()]))
        tables[-1].to_csv(tmp_path / f"{name}.csv", index=False)
    found = pd.concat(tables, ignore_index=True).drop(columns="seconds")
    pd.testing.assert_frame_equal(found, pd.read_csv(KEPT), rtol=1e-3)
