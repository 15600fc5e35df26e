"""Random numbers follow from a seed and the purpose that they are for."""

import pytest

from recalib.numerics import generator


def test_a_purpose_has_the_numbers_that_it_had():
    """All results of the study follow from them: another stream would change every one."""
    first = {(1,): 0.345584, (1, "links"): 1.20472, (1, "links", 2): -0.238553}
    for keys, number in first.items():
        assert generator(*keys).normal() == pytest.approx(number, rel=1e-5)


def test_a_zero_at_the_end_of_few_keys_is_no_other_purpose():
    firsts = [generator(1, *keys).normal() for keys in (("a", 2), ("a", 2, 0), ("a", 0, 2))]
    assert firsts[0] == firsts[1] != firsts[2]
