import pytest

from recalib.errors import UnknownName
from recalib.learners.kinds import class_of, kind_of
from recalib.learners.polynomial import PolynomialLearner


def test_a_learner_is_of_the_kind_of_its_own_class():
    class Other(PolynomialLearner):
        pass

    assert kind_of(PolynomialLearner(1)) == "polynomial"
    with pytest.raises(UnknownName, match="unknown kind of learner to save 'Other'"):
        kind_of(Other(1))


def test_an_unknown_kind_is_refused_with_the_known_ones():
    with pytest.raises(UnknownName, match=r"'hybird'; expected: .*; did you mean hybrid\?"):
        class_of("hybird")
