import math

import pytest

from recalib import quantities
from recalib.errors import InvalidQuantity


@pytest.mark.parametrize(("text", "metres"), [("4 cm", 0.04), ("-1.5 mm", -0.0015), ("+2 m", 2.0)])
def test_lengths(text, metres):
    assert quantities.length(text) == pytest.approx(metres)


@pytest.mark.parametrize(("text", "radians"), [("180 deg", math.pi), ("-0.5 rad", -0.5)])
def test_angles(text, radians):
    assert quantities.angle(text) == pytest.approx(radians)
    assert quantities.degrees(radians) == pytest.approx(math.degrees(radians))


@pytest.mark.parametrize("text", ["4", "4 deg", "cm", "4 inches", 4, None, "four cm", "4 cm 2"])
def test_what_is_no_length_is_refused_with_the_units(text):
    with pytest.raises(InvalidQuantity, match="cm, m, mm"):
        quantities.length(text)


def test_what_is_no_angle_is_refused_with_the_units():
    with pytest.raises(InvalidQuantity, match="deg, rad"):
        quantities.angle("4 cm")
