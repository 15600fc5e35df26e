"""What tiny alternative setups are and measure is as kept."""

import pytest

from replication.campaign import efforts, horizon, measuring, reference
from replication.campaign.design import put_together
from replication.campaign.power import power
from replication.campaign.universe import universe
from replication.config import lengths
from replication.config.shipped import SEARCHED
from tests.conftest import ROOT
from tests.kept import plain
from tests.replication.campaign.test_measuring import ITERATIONS, made_small
from workflow.scripts.call import write


@pytest.fixture(scope="module")
def setups(study, design):
    return [universe(study, designed) for designed in design]


def test_what_the_design_makes_of_the_study(setups, data_regression):
    data_regression.check({its.number: plain(its) for its in setups[::13]})


def test_what_two_replicates_of_a_setup_measure(setups, monkeypatch, data_regression):
    monkeypatch.setattr(measuring, "LATE", 2 * ITERATIONS)
    setup = made_small(setups[5], replicates=2)
    data_regression.check(plain({"rows": measuring.measure(setup)}))


def test_how_long_ritters_takes_in_a_setup(setups, data_regression):
    data_regression.check(plain({"rows": horizon.horizon(made_small(setups[6], replicates=2))}))


def test_what_a_replicate_of_the_reference_study_measures(
    study, uneven_scenario, monkeypatch, data_regression
):
    monkeypatch.setattr(measuring, "LATE", 2 * ITERATIONS)
    monkeypatch.setattr(lengths, "MAPS", (3, ITERATIONS))
    its = reference.reference_universe
    monkeypatch.setattr(reference, "reference_universe", lambda *told: made_small(its(*told)))
    data_regression.check(plain({"rows": reference.reference(uneven_scenario, study, 1)}))


@pytest.mark.parametrize("iterations", [4, 8])
def test_winners_by_the_effort_of_the_search(
    iterations, study, uneven_scenario, monkeypatch, data_regression
):
    for name, value in (("LONG", 8), ("FIRST", 2), ("WATCHED", 3)):
        monkeypatch.setattr(efforts, name, value)
    learner = study.learners["improved"].model_copy(update={"iterations": iterations})
    sample = ROOT / SEARCHED / "improved_200.csv"
    table = efforts.efforts(
        uneven_scenario, sample, "improved", learner, rough_trials=32, seeds=2, tests=5, seed=1
    )
    data_regression.check(plain(table))


def test_the_power_of_small_campaigns(data_regression):
    data_regression.check(plain(power(8, 2, studies=6)))


def test_chunks_of_a_campaign_are_put_together(tmp_path, data_regression):
    for number, name in enumerate("ab"):
        table = {"universe": [number], "intact": [1e-9 + number], "value": [3.5 - number]}
        write(tmp_path / f"{name}.csv", table)
    found = put_together([tmp_path / "a.csv", tmp_path / "b.csv"], "digest")
    data_regression.check(plain(found))
