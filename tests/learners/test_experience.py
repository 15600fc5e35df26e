from itertools import pairwise

from recalib.learners.experience import is_due


def test_looking_back_gets_rarer_and_never_lacks_more_than_a_fifth():
    due = [moves for moves in range(1, 1000) if is_due(moves - 1, moves)]
    assert due[:16] == [1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 14, 16, 20, 24, 28, 32]
    assert all(after <= 1.25 * before for before, after in pairwise(due[3:]))


def test_many_moves_at_once_are_looked_at_once():
    assert is_due(0, 1000) and not is_due(1000, 1001)
