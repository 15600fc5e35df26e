"""Trainings on many robots."""

import pytest

from replication.config import Ensemble
from replication.training import train_ensemble
from tests.replication.conftest import settings_of


def trained(study, folder, **its):
    changes = {"ensemble": Ensemble(**its), "iterations": 5, "switches": False}
    plan = study.experiments.model_copy(update=changes)
    training = study.training.model_copy(update={"tests": 10})
    few = study.model_copy(update={"experiments": plan, "training": training})
    return train_ensemble(few, settings_of(few, folder / "outcomes.csv"))


@pytest.fixture(scope="module")
def table(study, tmp_path_factory):
    return trained(study, tmp_path_factory.mktemp("settings"), draws=6, scales=(1.0, 3.0))


def test_each_robot_has_all_scales_of_its_damage(table):
    assert table[["draw", "scale"]].to_numpy().tolist() == [
        [draw, scale] for draw in range(6) for scale in (1, 3)
    ]
    error = table["initial_position_error_cm"].to_numpy().reshape(-1, 2)
    assert (error[:, 1] > 2 * error[:, 0]).all()


def test_learning_helps_each_of_them(table):
    for error in ("position_error_cm", "orientation_error_deg"):
        assert (table[f"final_{error}"] < table[f"initial_{error}"]).all()


def test_links_are_long_enough_for_the_largest_damage(study, table, tmp_path):
    """Though the smallest leaves more robots to draw from: some are others then."""
    small = trained(study, tmp_path, draws=6, scales=(1.0,))["initial_position_error_cm"]
    assert small.tolist() != table["initial_position_error_cm"][::2].tolist()
