import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from recalib import InvalidQuantity
from recalib.files import ANGLE, COMPLIANCE, LENGTH


@pytest.mark.parametrize(
    ("quantity", "text", "value"),
    [
        (LENGTH, "4 cm", 0.04),
        (LENGTH, "-1.5 mm", -0.0015),
        (LENGTH, "+2 m", 2.0),
        (ANGLE, "180 deg", math.pi),
        (ANGLE, "-0.5 rad", -0.5),
        (COMPLIANCE, "1 deg/Nm", math.pi / 180),
    ],
)
def test_a_quantity_is_read_in_si_units(quantity, text, value):
    assert quantity.read(text) == pytest.approx(value)


@pytest.mark.parametrize(
    "text", ["4", "4 deg", "cm", "4 inches", 4, None, "four cm", "4 cm 2", "1e400 m", "nan m"]
)
def test_what_is_no_length_is_refused_with_the_units(text):
    with pytest.raises(InvalidQuantity, match="cm, m, mm"):
        LENGTH.read(text)


@given(st.floats(-100, 100))
@pytest.mark.parametrize("quantity", [LENGTH, ANGLE, COMPLIANCE])
def test_what_is_written_reads_as_the_very_same_number(quantity, value):
    assert quantity.read(quantity.write(value)) == value


@pytest.mark.parametrize("text", ["4 cm", "-2 cm", "0.2 mm", "12 m", "200 m"])
def test_round_lengths_are_written_as_people_write_them(text):
    assert LENGTH.write(LENGTH.read(text)) == text
