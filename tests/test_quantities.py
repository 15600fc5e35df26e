"""Quantities with units: how they are read and written, and how far each goes."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import TypeAdapter, ValidationError

from recalib import InvalidQuantity
from recalib.files import ANGLE, COMPLIANCE, LENGTH, bounded


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


@pytest.mark.parametrize(
    ("name", "taken", "refused"),
    [
        ("Length", ("-100 m", "100 m"), ("-101 m", "101 m", "3 deg")),
        ("Amount", ("0 m", "100 m"), ("-0.1 m", "101 m")),
        ("Size", ("0.1 mm", "100 m"), ("0 m", "101 m")),
        ("Angle", ("-100 rad", "100 rad"), ("-101 rad", "101 rad", "3 cm")),
        ("Turn", ("0 deg", "180 deg"), ("-1 deg", "181 deg")),
        ("SignedTurn", ("-180 deg", "180 deg"), ("-181 deg", "181 deg")),
        ("Direction", ("-360 deg", "360 deg"), ("-361 deg", "361 deg")),
        ("Noise", ("0 m", "10 cm"), ("-1 mm", "10.1 cm")),
        ("NoiseOfTurn", ("0 deg", "10 deg"), ("-1 deg", "10.1 deg")),
        ("Compliance", ("0 deg/Nm", "1 rad/Nm"), ("-1 deg/Nm", "1.1 rad/Nm", "1 rad")),
        ("Side", ("1 mm", "100 m"), ("0.9 mm", "101 m")),
        ("Range", ("0.1 deg", "180 deg"), ("0.05 deg", "181 deg")),
    ],
)
def test_a_quantity_is_taken_to_its_bounds_and_written_as_it_reads(name, taken, refused):
    kind = TypeAdapter(getattr(bounded, name))
    for text in taken:
        assert kind.dump_python(kind.validate_python(text), mode="json") == text
    for text in (*refused, "4", 4, 0, 0.0, math.nan, "nan m", "inf m", None, True, [], ""):
        with pytest.raises(ValidationError, match=" from .* to .*, such as '| above 0 and up to "):
            kind.validate_python(text)
