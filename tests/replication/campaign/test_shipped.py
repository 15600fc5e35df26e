"""The campaign's shipped tables come again, number by number: only its searches take hours."""

import pandas as pd
import pytest

from replication.campaign import DOUBLE, TWO_MAPS, lengths, tune
from replication.campaign.drawing import draw, rows
from replication.campaign.halfway import halfway
from replication.campaign.measuring import measure_variant
from replication.campaign.setups import planned
from replication.campaign.ship import ship
from replication.campaign.untrained import untrained
from replication.campaign.variants import variants
from replication.config import CAMPAIGN, DESIGN, IMPROVED, RITTER
from replication.running import write
from tests.conftest import ROOT, changed
from tests.replication.conftest import ALONE

OUTCOMES = pd.read_csv(ROOT / CAMPAIGN / "outcomes.csv")
OF_SEARCHES = ["trials", "apart", "settled", "seconds"]


def shipped(name: str, setup: int, replicate: int = 0) -> pd.DataFrame:
    """The rows of a variant."""
    own = OUTCOMES.query("variant == @name and setup == @setup and replicate == @replicate")
    return own.dropna(axis=1, how="all").reset_index(drop=True)


@pytest.fixture
def searches(monkeypatch):
    """Searches find what is in a table, at once; gives the function that says in which.

    That returns the poses' name, the runs and the settings from which it begins, of each search.
    """

    def find(table: pd.DataFrame) -> list:
        settings, begun = table.set_index("iterations"), []

        def begin(search, *_):
            poses, columns = search._trials.poses, list(search._trials.space.columns)
            start = search._start is not None and dict(zip(columns, search._start, strict=True))
            begun.append((poses.name, len(poses.desired), start))
            row = settings.loc[poses.desired.shape[1], columns]
            given = search._trials.space.constant
            assert row[list(given)].to_dict() == dict(given)
            search.best = row.to_numpy(float)

        monkeypatch.setattr("replication.training.search.Search.begin", begin)
        return begun

    return find


def assert_same(again: pd.DataFrame, table: pd.DataFrame) -> None:
    """But for what the searches say of themselves."""
    columns = [name for name in again if name not in OF_SEARCHES]
    table = table[columns].reset_index(drop=True)
    pd.testing.assert_frame_equal(again[columns], table, check_dtype=False, rtol=2e-3)
    assert not again.get("apart", pd.Series()).any(), "all searches found the same"


def test_the_design_is_drawn_again(study):
    """Those setups whose damage is the nearest of thousands take longer: two of them."""
    design = pd.read_csv(ROOT / DESIGN, dtype=str, keep_default_na=False)
    planned = [*rows(study.campaign)]
    some = design[(design["assignment"] == "any") | design["setup"].isin(["0", "3"])]
    assert len(some) > 14
    for row in some.to_dict("records"):
        drawn = draw(study, int(row["setup"]), planned[int(row["row"])]).as_row()
        assert {name: str(value) for name, value in drawn.items()} == row


def test_the_arms_without_a_learner_are_measured_again(study):
    table = pd.read_csv(ROOT / CAMPAIGN / "untrained.csv")
    pd.testing.assert_frame_equal(untrained(study, ROOT / DESIGN), table)


@pytest.mark.parametrize(
    ("name", "setup", "replicate"),
    [
        (IMPROVED, 1, 1),
        (RITTER, 2, 0),
        ("radial_increments", 7, 0),
        ("improved_drastic", 13, 0),
        ("improved_rough", 1, 1),
        ("ritter_random_start", 1, 1),
        ("two_maps_for_position_reverse", 20, 0),
        ("two_maps_for_position_wide", 28, 0),
        ("small_subnet_for_orientation", 18, 0),
    ],
)
def test_the_best_settings_leave_the_same_errors_again(
    study, searches, tmp_path, name, setup, replicate
):
    """A longer training is searched near the settings of the shorter one, in fewer runs."""
    table, others = shipped(name, setup, replicate), []
    for held in (TWO_MAPS, "small_subnet"):
        others.append(tmp_path / f"{held}.csv")
        write(others[-1], shipped(held, setup, replicate))
    begun, near = searches(table), changed(study, search={"near": 200, "long": 100, "fresh": 1})
    assert_same(measure_variant(near, ROOT / DESIGN, setup, replicate, name, others), table)
    assert [search[:2] for search in begun] == [
        (f"search {number} in setup {setup}, replicate {replicate}", study.search.long_runs)
        for _ in table["iterations"]
        for number in (1, 2)
    ] * ("rough" not in name)
    assert not any(start for *_, start in begun[:2])
    assert all(start == table.loc[0, [*start]].to_dict() for *_, start in begun[2:])


def test_every_variant_has_its_lengths_and_more_until_both_errors_are_reached(
    study, searches, tmp_path
):
    for name, variant in variants(study).items():
        for setup in (0, 1):
            own, found = {*lengths(variant, setup)}, {*shipped(name, setup).get("iterations", ())}
            assert own <= found <= own | {*variant.until_reached}
    table, plan = shipped(DOUBLE, 3), {"rungs": (600,), "runs": 9}
    searches(pd.concat([table[:2], table[1:2].assign(iterations=600)]))
    few, goal = changed(study, campaign=plan, search={"fresh": 1}), tmp_path / f"{IMPROVED}.csv"
    between = table[["position_share", "orientation_share"]][:2].max(axis=1).mean()
    for larger, more in ((between, []), (1e-6, [600])):
        shares = {"position_share": 1e-6, "orientation_share": larger}
        write(goal, shipped(IMPROVED, 3).assign(**shares))
        found = measure_variant(few, ROOT / DESIGN, 3, 0, DOUBLE, [goal])
        assert found["iterations"].tolist() == [200, 500, *more]


def test_the_search_in_between_begins_where_the_shorter_one_ended(study, searches, monkeypatch):
    monkeypatch.setattr("replication.campaign.halfway.ITERATIONS", 500)
    table, begun = shipped(DOUBLE, 3), searches(shipped(DOUBLE, 3))
    first = changed(study, campaign={"rungs": (500,)}, search={"fresh": 1})
    assert_same(halfway(first, ROOT / DESIGN, ROOT / CAMPAIGN / "outcomes.csv", 3, 0), table[1:2])
    assert [name for name, *_ in begun] == [
        f"search {number} in setup 3, replicate 0" for number in (1, 2)
    ]
    assert all(start == table.loc[1, [*start]].to_dict() for *_, start in begun)


def test_what_was_shipped_is_not_measured_again(study, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    few = changed(study, campaign={"setups": 4, "replicated": 1, "replicates": 2})
    assert planned(few) == [(0, 0), (0, 1), (1, 0), (2, 0), (3, 0)]
    (tmp_path / CAMPAIGN).mkdir(parents=True)
    for setup, replicate, error in ((2, 0, 1.0), (0, 1, 2.0), (2, 0, 3.0)):
        row = {"setup": setup, "replicate": replicate, "variant": IMPROVED, "iterations": 200}
        table = pd.DataFrame([row | {"position_error_cm": error}])
        write(tmp_path / f"{error}/{setup}/{replicate}.csv", table)
        ship(tmp_path / f"{error}")
    assert pd.read_csv(f"{CAMPAIGN}/outcomes.csv")["position_error_cm"].tolist() == [2.0, 3.0]
    assert planned(few) == [(0, 0), (1, 0), (3, 0)]


def test_a_study_of_ones_own_is_tuned_in_the_setup_of_its_first_levels(
    study, plan, searches, tmp_path
):
    """But for its robot and coordinates: with the seed of setup 0 the numbers are those of that."""
    seed = int(pd.read_csv(ROOT / DESIGN)["seed"][0])
    factors = changed(study.campaign.factors, robot=("z1",), coordinates=("rotation_vector",))
    lengths = {"learners": {IMPROVED: (200,)}, "evidence": False}
    own = changed(study, seed=seed, campaign={"factors": factors}, experiments=ALONE | lengths)
    own = changed(own, benchmark={"papers": {}}, real={"twin": {}}, search={"fresh": 1})
    write(scenario := tmp_path / "scenario.json", plan.resolved(study.scenario))
    table = shipped(IMPROVED, 0).query("iterations == 200")
    begun = searches(table)
    assert_same(tune(own, IMPROVED, scenario), table)
    assert [runs for _, runs, _ in begun] == [study.search.runs] * 2
