"""Trainings on many robots."""

import numpy as np
import pytest

from replication.config.study import Series
from replication.scenarios.assignments import Ways
from replication.training.ensemble import feasible, train_draws
from tests.replication.conftest import settings_of

SERIES = {"others": Series(draws=3, scales=(1,)), "scaled": Series(draws=6, scales=(1.0, 3.0))}


@pytest.fixture(scope="module")
def few(study):
    plan = study.experiments.model_copy(
        update={"ensemble": {"improved": SERIES}, "iterations": 5, "switches": False}
    )
    training = study.training.model_copy(update={"tests": 10})
    return study.model_copy(update={"experiments": plan, "training": training})


@pytest.fixture(scope="module")
def table(few, tmp_path_factory):
    settings = settings_of(few, tmp_path_factory.mktemp("settings") / "outcomes.csv")
    return train_draws(few, "improved", settings)


def test_each_robot_of_a_series_has_all_scales_of_its_damage(table):
    assert table[["series", "draw", "scale"]].to_numpy().tolist() == [
        *[["others", draw, 1] for draw in range(3)],
        *[["scaled", draw, scale] for draw in range(6) for scale in (1, 3)],
    ]
    scaled = table[table["series"] == "scaled"]
    error = scaled["initial_position_error_cm"].to_numpy().reshape(-1, 2)
    assert (error[:, 1] > 2 * error[:, 0]).all()


def test_the_robots_of_two_series_are_others(table):
    first = [its["initial_position_error_cm"].iloc[0] for _, its in table.groupby("series")]
    assert not np.isclose(*first, rtol=1e-3)


def test_learning_helps_each_of_them(table):
    for error in ("position_error_cm", "orientation_error_deg"):
        assert (table[f"final_{error}"] < table[f"initial_{error}"]).all()


def test_links_are_long_enough_for_the_largest_damage_of_a_series(study, plan, robot):
    """Though the smallest leaves more of them to draw from."""
    damage = study.paper_damage
    ways = Ways(plan.nominal("ur10").robot.links, damage.shorten, robot.joints, damage.shift)
    some = range(0, len(ways), 40)
    assert len([*feasible(robot, ways, some, 1.0)]) == len(some)
    assert len([*feasible(robot, ways, some, 3.0)]) < len(some)
