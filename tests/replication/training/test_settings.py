"""Widths and rates: as rows that a learner takes, and as points that a search moves."""

from dataclasses import replace

import numpy as np
import pytest

from recalib import RecalibError, Rules
from replication.config import SWITCHES, Ranges, RoughSearch
from replication.training import SearchPoses, Space, Stream, Trials, Tuned, Tuning, worse
from tests.replication.campaign.planted import Planted, valley


@pytest.fixture
def space(study):
    return Space(Rules(True, True, True, True), study.search.ranges)


def points(count, dimensions=7):
    return np.random.default_rng(1).uniform(0, 1, (count, dimensions))


def columns(space, rows):
    return dict(zip(space.columns, rows.T, strict=True))


def test_points_fill_the_ranges_and_widths_and_rates_fall(space, study):
    settings = columns(space, space.rows(points(200)))
    low, high = study.search.ranges.widths
    for name in space.neighbourhoods:
        assert (low * 0.999 <= settings[name]).all()
        assert (settings[name] <= settings["initial_width"] * 1.001).all()
    assert settings["initial_width"].max() > 0.7 * high
    assert settings["initial_width"].min() < 2 * low
    assert (settings["final_rate"] <= settings["initial_rate"] * 1.001).all()
    assert settings["initial_rate"].max() <= 1
    ends = columns(space, space.rows(np.array([[1, 0, 1, 0, 1, 1, 1]])))
    assert [ends[name][0] for name in space.columns] == [high, low, high, low, high, 1, 1]


def test_a_row_and_its_point_are_the_same(space):
    rows = space.rows(points(20))
    again = space.rows(np.stack([space.point(row) for row in rows]))
    assert np.allclose(rows, again, rtol=2e-3)  # four digits of each


def test_a_neighbourhood_that_is_to_be_narrower_is_and_a_given_width_does_not_fall(study):
    rules = Rules(True, False, False, False)
    narrower = {"position_g_k": "position_g_kl"}
    space = Space(rules, study.search.ranges, narrower=narrower)
    settings = columns(space, space.rows(points(100)))
    assert (settings["position_g_k"] <= settings["position_g_kl"] * 1.001).all()
    assert (settings["orientation_g_k"] > settings["orientation_g_kl"]).any()
    space = Space(rules, study.search.ranges, constant={"position_g_k": 2.0})
    assert "position_g_k" not in space.coordinates and len(space.coordinates) == 6
    rows = space.rows(points(5, 6))
    assert (columns(space, rows)["position_g_k"] == 2.0).all()
    schedule = space.schedule(rows)
    assert np.allclose(schedule.initial_width["position"][0], 2.0)
    assert np.allclose(schedule.final_widths["position"][0], 2.0)


def test_a_learner_has_the_settings_of_the_reference_study_alone(study, settings):
    """Rows of other setups and replicates have no numbers there."""
    learner = Tuned(study, settings).learner("improved", 200, 3)
    assert np.shape(learner.schedule.initial_width) == (3,)
    assert np.isfinite(learner.schedule.initial_width).all()
    others = Tuned(study, settings).learner("improved", 500, 3)
    assert others.schedule.initial_width[0] != learner.schedule.initial_width[0]
    with pytest.raises(RecalibError, match="no settings of improved for 201 iterations; try: make"):
        Tuned(study, settings).learner("improved", 201, 1)


@pytest.mark.parametrize("switch", SWITCHES)
def test_a_switch_changes_one_thing_of_each_system(study, switch):
    rules_by_name = {name: rules.model_dump() for name, rules in study.every_learner.items()}
    improved, ritter = rules_by_name["improved"], rules_by_name["ritter"]
    without, added = rules_by_name[switch.without], rules_by_name[switch.added]
    cells = {"supernet": (3, 6, 3)} if switch.key == "maps" else {}  # as many in one map as in two
    assert without == improved | {switch.key: ritter[switch.key]} | cells
    assert added == ritter | {switch.key: improved[switch.key]}


def valley_at(width: float, space) -> Planted:
    """Trials whose optimum is this width with a rate of 0.8: there, a tenth remains."""

    def surface(settings):
        logs = np.log(0.1) + valley(settings["initial_rate"], 0.8)
        logs = logs + sum(valley(settings[name], width) for name in space.neighbourhoods)
        return np.stack([logs, logs - 0.5], axis=-1)

    none = np.zeros((1, 0, 6))
    return Planted(space, SearchPoses("search", none, none), surface, np.zeros((1, 2)))


@pytest.fixture
def tuning(study, space):
    trials = valley_at(0.5, space)
    plan = study.search.model_copy(update={"trials": 960, "near_trials": 160, "doublings": 1})
    return Tuning([trials, trials], trials, plan)


def test_searches_that_find_the_same_have_converged(tuning):
    found = tuning.search()
    assert found.settled and found.trials == 960
    assert found.scores == pytest.approx(0.1, rel=0.02)
    settings = dict(zip(tuning.fresh.space.columns, found.best, strict=True))
    assert settings["initial_rate"] == pytest.approx(0.8, rel=0.15)
    for name in tuning.fresh.space.neighbourhoods:
        assert settings[name] == pytest.approx(0.5, rel=0.3)
    starts = found.rows * 1.1
    found = tuning.search(starts=np.minimum(starts, [20] * 5 + [1] * 2))
    assert found.settled and found.trials == 160 and found.scores.max() < 0.102
    effort = RoughSearch(trials=16, ranges=Ranges(widths=(0.1, 5.0), rates=(0.1, 1.0)))
    found = tuning.rough(effort)
    assert found.trials == 16 and not found.settled
    assert len(found.scores) == 1 and 0.1 < found.scores[0] < 1
    assert (found.best[:5] >= 0.0999).all() and (found.best[:5] <= 5.001).all()


def test_searches_that_do_not_begin_again_once_with_twice_as_many_trials(tuning):
    apart = replace(tuning, trials=[tuning.fresh, valley_at(2.0, tuning.fresh.space)])
    found = apart.search()
    assert not found.settled and found.trials == 960 * 3
    assert found.scores.max() > 1.02 * found.scores.min()
    assert found.scores.argmin() == 0, "the best is that which leaves least on fresh poses"
    assert (found.best == found.rows[0]).all()


def test_the_larger_remaining_share_counts():
    assert worse(np.array([[0.1, 0.3], [0.2, 0.1]])).tolist() == [0.3, 0.2]


def test_a_share_is_of_the_arms_own_error_and_a_learner_that_diverges_is_worst(study, uneven):
    controller = uneven.controller()
    space = Space(Rules(True, True, True, True), study.search.ranges)
    poses = Stream.SEARCH.draw(1, [0, 1], 30, 20, number=0, setup=0, replicate=0)
    trials = Trials(space, poses, lambda runs: uneven.plant(controller, 1, range(runs)))
    good, nothing = [4.6, 0.6, 0.6, 0.6, 0.6, 0.99, 0.7], [4.6, 0.6, 0.6, 0.6, 0.6, 0.02, 0.02]
    shares, errors = (ask(np.array([good, nothing])) for ask in (trials.shares, trials.outcome))
    logs = np.log(errors.errors / trials.uncorrected)
    assert shares == pytest.approx(np.exp(logs.mean(axis=1))), "of runs, a geometric mean"
    assert (shares[0] < 0.5).all() and (shares[1] > 0.5).all()
    assert trials.uncorrected.shape == (2, 2) and (trials.uncorrected > 0.005).all()
    first = trials.first(1).poses
    assert np.array_equal(first.desired, poses.desired[:1])
    assert np.array_equal(first.tests, poses.tests[:1])
