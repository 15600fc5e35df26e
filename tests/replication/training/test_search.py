"""A search finds the optimum, and says whether another one finds the same."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

from recalib import Rules
from replication.config import Ranges, RoughSearch
from replication.training import SearchPoses, Space, Stream, Trials, Tuning, worse
from tests.replication.campaign.planted import valley

NONE = np.zeros((1, 0, 6))


@dataclass(frozen=True)
class Valley:
    """Trials whose optimum is a width of 0.5 with a rate of 0.8: there, a tenth remains."""

    space: Space
    poses = SearchPoses("search", NONE, NONE)
    misled: float = 1.0  # factor of the optimal width, as by poses that are few

    def first(self, runs):
        return self

    def shares(self, rows):
        its = dict(zip(self.space.columns, rows.T, strict=True))
        logs = np.log(0.1) + valley(its["initial_rate"], 0.8)
        for name in self.space.neighbourhoods:
            logs = logs + valley(its[name], 0.5 * self.misled)
        return np.exp(np.stack([logs, logs - 0.5], axis=-1))


@pytest.fixture
def tuning(study):
    its = Valley(Space(Rules(True, True, True, True), study.search.ranges))
    plan = study.search.model_copy(update={"trials": 960, "near_trials": 160, "doublings": 1})
    return Tuning([its, its], its, plan)


def test_searches_that_find_the_same_have_converged(tuning):
    found = tuning.search()
    assert found.settled and found.trials == 960
    assert found.scores == pytest.approx(0.1, rel=0.02)
    its = dict(zip(tuning.fresh.space.columns, found.best, strict=True))
    assert its["initial_rate"] == pytest.approx(0.8, rel=0.15)
    for name in tuning.fresh.space.neighbourhoods:
        assert its[name] == pytest.approx(0.5, rel=0.3)


def test_searches_that_do_not_begin_again_once_with_twice_as_many_trials(tuning):
    apart = replace(tuning, trials=[tuning.fresh, replace(tuning.fresh, misled=4.0)])
    found = apart.search()
    assert not found.settled and found.trials == 960 * 3
    assert found.scores.max() > 1.02 * found.scores.min()
    assert found.scores.argmin() == 0, "the best is that which leaves least on fresh poses"
    assert (found.best == found.rows[0]).all()


def test_near_a_start_few_trials_are_enough(tuning):
    starts = tuning.search().rows * 1.1
    found = tuning.search(starts=np.minimum(starts, [20] * 5 + [1] * 2))
    assert found.settled and found.trials == 160 and found.scores.max() < 0.102


def test_a_rough_search_takes_the_best_of_few_settings(tuning):
    effort = RoughSearch(trials=16, ranges=Ranges(widths=(0.1, 5.0), rates=(0.1, 1.0)))
    found = tuning.rough(effort)
    assert found.trials == 16 and not found.settled
    assert 0.1 < found.scores[0] < 1
    assert (found.best[:5] >= 0.0999).all() and (found.best[:5] <= 5.001).all()


def test_the_larger_remaining_share_counts():
    assert worse(np.array([[0.1, 0.3], [0.2, 0.1]])).tolist() == [0.3, 0.2]


def test_a_share_is_of_the_arms_own_error_and_a_learner_that_diverges_is_worst(study, uneven):
    controller = uneven.controller()
    space = Space(Rules(True, True, True, True), study.search.ranges)
    poses = Stream.SEARCH.draw(1, [0, 1], 30, 20, number=0, setup=0, replicate=0)
    its = Trials(space, poses, lambda runs: uneven.plant(controller, 1, range(runs)))
    good, nothing = [4.6, 0.6, 0.6, 0.6, 0.6, 0.99, 0.7], [4.6, 0.6, 0.6, 0.6, 0.6, 0.02, 0.02]
    shares = its.shares(np.array([good, nothing]))
    assert (shares[0] < 0.5).all() and (shares[1] > 0.5).all()
    assert its.uncorrected.shape == (2, 2) and (its.uncorrected > 0.005).all()
