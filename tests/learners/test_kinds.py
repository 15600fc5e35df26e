import numpy as np
import pytest

from recalib import Outcome, PolynomialLearner, UnknownName
from recalib.learners import KINDS, class_of, kind_of


def test_a_learner_is_of_the_kind_of_its_own_class():
    class Other(PolynomialLearner):
        pass

    assert kind_of(PolynomialLearner(1)) == "polynomial"
    with pytest.raises(UnknownName, match="unknown kind of learner to save 'Other'"):
        kind_of(Other(1))


def test_an_unknown_kind_is_refused_with_the_known_ones():
    with pytest.raises(UnknownName, match=r"'hybird'; expected: .*; did you mean hybrid\?"):
        class_of("hybird")


@pytest.mark.parametrize("name", KINDS)
def test_what_is_learned_later_leaves_a_state_as_it_was(name, makers):
    learner, poses = makers[name](runs=2), np.random.default_rng(1).uniform(-1, 1, (2, 9, 6))

    def learn(moves):
        for move in moves:
            learner.learn(
                poses[:, move], lambda sent: Outcome(0.9 * sent, np.ones((2, 1), dtype=bool)), 0.0
            )

    learn(range(3))
    state, commands = learner.state(), learner.command(poses)
    learn(range(3, 9))
    assert not np.array_equal(learner.command(poses), commands)
    learner.restore(state)
    assert np.array_equal(learner.command(poses), commands)
