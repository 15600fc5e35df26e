"""The jobs besides trainings: benchmark, ensemble, replay and constant widths."""

import numpy as np
import pandas as pd
import pytest

from replication.config import Ensemble
from replication.training import Stream, Tuned, compete, rules_of, train_ensemble
from replication.training import constant_widths as module
from replication.training.replay import replay
from tests.conftest import changed
from tests.replication.conftest import settings_of


def of(study, **update):
    plan = {"seeds": 2, "moves": (2, 4), "longer": (8, 3), "papers": {"improved": 200}} | update
    return changed(study, benchmark=plan, training={"tests": 3})


def test_scenarios_side_by_side_are_what_each_of_them_is_alone(study):
    def competed(*scenarios):
        return compete(of(study, scenarios=scenarios), "affine", [])

    both = competed("links", "rotation")
    assert both.groupby(["scenario", "seed"])["moves"].agg(list).to_dict() == {
        (name, seed): [2, 3, 4] for name in ("links", "rotation") for seed in (0, 1)
    }
    for name in ("links", "rotation"):
        beside = both[both["scenario"] == name].reset_index(drop=True)
        pd.testing.assert_frame_equal(beside, competed(name), rtol=1e-6)


def test_a_learner_of_the_paper_moves_twice_an_iteration_by_its_settings(study, settings):
    table = compete(of(study, scenarios=("rotation",)), "improved", settings)
    assert table["moves"].tolist() == [2, 4, 8] * 2
    assert table["iteration"].tolist() == [1, 2, 4] * 2
    assert (table["learner"] == "improved").all()


def trained(study, folder, **ensemble):
    plan = {"ensemble": Ensemble(**ensemble), "iterations": 5, "switches": False}
    few = changed(study, experiments=plan, training={"tests": 10})
    return train_ensemble(few, settings_of(few, folder / "outcomes.csv"))


@pytest.fixture(scope="module")
def table(study, tmp_path_factory):
    return trained(study, tmp_path_factory.mktemp("settings"), draws=6, scales=(1.0, 3.0))


def test_each_robot_has_all_scales_of_its_damage_and_learning_helps(table):
    assert table[["draw", "scale"]].to_numpy().tolist() == [
        [draw, scale] for draw in range(6) for scale in (1, 3)
    ]
    error = table["initial_position_error_cm"].to_numpy().reshape(-1, 2)
    assert (error[:, 1] > 2 * error[:, 0]).all()
    for error in ("position_error_cm", "orientation_error_deg"):
        assert (table[f"final_{error}"] < table[f"initial_{error}"]).all()


def test_links_are_long_enough_for_the_largest_damage(study, table, tmp_path):
    """Though the smallest leaves more robots to draw from: some are others then."""
    small = trained(study, tmp_path, draws=6, scales=(1.0,))["initial_position_error_cm"]
    assert small.tolist() != table["initial_position_error_cm"][::2].tolist()


def test_a_learner_learns_the_same_from_a_table_as_from_the_robot(study, uneven, settings):
    tuned = Tuned(study, settings)
    table = replay(uneven, lambda: tuned.learner("improved", 200, 1), 6, seed=4)
    assert (table["difference"] == 0).all() and len(table) >= 4, "theta and Jacobians of two maps"


def test_a_table_answers_no_command_that_was_never_sent(study, uneven, settings):
    """So a learner that learned from anything else would be found out."""
    tuned, lengths = Tuned(study, settings), iter((200, 500))
    with pytest.raises(KeyError):
        replay(uneven, lambda: tuned.learner("improved", next(lengths), 1), 6, seed=4)


RUNS, ITERATIONS = 3, 40


@pytest.fixture
def improved(study):
    return rules_of(study.learners["improved"])


def halved_after(resolved, improved, rate: float, width: float = 1.0) -> np.ndarray:
    poses = Stream.WIDTHS.draw(7, range(RUNS), ITERATIONS, 20)
    rates = np.full(RUNS, rate)
    return module.halved_after(resolved, improved, width, rates, poses, 7)


def test_who_hardly_learns_is_not_said_to_have_halved_anything(uneven, improved):
    assert (halved_after(uneven, improved, 1e-6) == ITERATIONS).all()


def test_wide_neighbourhoods_halve_both_errors_soon_and_narrow_ones_late(uneven, improved):
    wide = halved_after(uneven, improved, 0.8)
    assert (wide > 0).all() and (wide < ITERATIONS / 2).all()
    assert (halved_after(uneven, improved, 0.8, module.WIDTHS["narrow"]) > wide).all()


def test_each_width_gets_the_better_of_two_rates(uneven, improved, monkeypatch):
    monkeypatch.setattr(module, "ITERATIONS", ITERATIONS)
    monkeypatch.setattr(module, "SEEDS", 2)
    monkeypatch.setattr(module, "RATES", np.array([0.8, 1e-6]))
    table = module.constant_widths(uneven, improved, 7)
    assert table["rate"].tolist() == [0.8] * 4
    assert table["seed"].tolist() == [0, 1] * 2
