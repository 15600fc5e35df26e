"""The campaign's design and table: what is published follows from the study."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from replication.campaign import DOUBLE, TWO_MAPS, Replicate
from replication.campaign.drawing import draw
from replication.campaign.factors import rows
from replication.campaign.measuring import measure_variant
from replication.campaign.setups import read_design
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
