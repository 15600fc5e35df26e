from itertools import pairwise

import numpy as np

from recalib.learners.experience import Experience, is_due


def test_a_run_remembers_the_moves_that_it_carried_out():
    experience = Experience(2)
    for number in range(3):
        moves = np.full((2, 1, 6), number)
        experience.add(moves, -moves, np.array([[number != 1], [True]]))
    sent, achieved = experience.of(0)
    assert sent[:, 0].tolist() == [0, 2] and achieved[:, 0].tolist() == [0, -2]
    assert len(experience.of(1)[0]) == experience.moves == 3


def test_looking_back_gets_rarer_and_never_lacks_more_than_a_fifth():
    due = [moves for moves in range(1, 1000) if is_due(moves - 1, moves)]
    assert due[:16] == [1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 14, 16, 20, 24, 28, 32]
    assert all(after <= 1.25 * before for before, after in pairwise(due[3:]))


def test_many_moves_at_once_are_looked_at_once():
    assert is_due(0, 1000) and not is_due(1000, 1001)
