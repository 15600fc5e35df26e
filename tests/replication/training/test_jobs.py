"""The jobs besides trainings: benchmark, ensemble and replay. See also test_kept.py."""

import pandas as pd
import pytest

from replication.config import Ensemble
from replication.training import Tuned, compete, train_ensemble
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


def test_links_are_long_enough_for_the_largest_damage(study, tmp_path):
    """Though the smallest leaves more robots to draw from: some are others then."""
    errors = []
    for scales in ((1.0,), (1.0, 3.0)):
        plan = {"ensemble": Ensemble(draws=6, scales=scales), "iterations": 5, "switches": False}
        few = changed(study, experiments=plan, training={"tests": 10})
        table = train_ensemble(few, settings_of(few, tmp_path / "outcomes.csv"))
        errors.append(table["initial_position_error_cm"].tolist())
    assert errors[0] != errors[1][::2]


def test_a_table_answers_no_command_that_was_never_sent(study, uneven, settings):
    """So a learner that learned from anything else would be found out."""
    tuned, lengths = Tuned(study, settings), iter((200, 500))
    with pytest.raises(KeyError):
        replay(uneven, lambda: tuned.learner("improved", next(lengths), 1), 6, seed=4)
