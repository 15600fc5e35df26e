import pytest

from replication.training import Tuned
from replication.training.replay import replay


def test_a_learner_learns_the_same_from_a_table_as_from_the_robot(study, uneven, settings):
    tuned = Tuned(study, settings)
    table = replay(uneven, lambda: tuned.learner("improved", 200, 1), 6, seed=4)
    assert (table["difference"] == 0).all() and len(table) >= 4, "theta and Jacobians of two maps"


def test_a_table_answers_no_command_that_was_never_sent(study, uneven, settings):
    """So a learner that learned from anything else would be found out."""
    tuned, lengths = Tuned(study, settings), iter((200, 500))
    with pytest.raises(KeyError):
        replay(uneven, lambda: tuned.learner("improved", next(lengths), 1), 6, seed=4)
