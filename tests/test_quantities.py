import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from recalib.errors import InvalidQuantity
from recalib.quantities import ANGLE, COMPLIANCE, LENGTH


@pytest.mark.parametrize(("text", "metres"), [("4 cm", 0.04), ("-1.5 mm", -0.0015), ("+2 m", 2.0)])
def test_lengths(text, metres):
    assert LENGTH.read(text) == pytest.approx(metres)


@pytest.mark.parametrize(("text", "radians"), [("180 deg", math.pi), ("-0.5 rad", -0.5)])
def test_angles(text, radians):
    assert ANGLE.read(text) == pytest.approx(radians)


def test_compliances():
    assert COMPLIANCE.read("1 deg/Nm") == pytest.approx(math.pi / 180)


@pytest.mark.parametrize(
    "text", ["4", "4 deg", "cm", "4 inches", 4, None, "four cm", "4 cm 2", "1e400 m", "nan m"]
)
def test_what_is_no_length_is_refused_with_the_units(text):
    with pytest.raises(InvalidQuantity, match="cm, m, mm"):
        LENGTH.read(text)


def test_what_is_no_angle_is_refused_with_the_units():
    with pytest.raises(InvalidQuantity, match="deg, rad"):
        ANGLE.read("4 cm")


@given(st.floats(-100, 100))
@pytest.mark.parametrize("quantity", [LENGTH, ANGLE, COMPLIANCE])
def test_what_is_written_reads_as_the_very_same_number(quantity, value):
    assert quantity.read(quantity.write(value)) == value


@pytest.mark.parametrize("text", ["4 cm", "-2 cm", "0.2 mm", "12 m", "200 m"])
def test_round_lengths_are_written_as_people_write_them(text):
    assert LENGTH.write(LENGTH.read(text)) == text
