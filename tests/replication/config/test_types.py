"""Types of the configuration's values: what each takes, to its bounds."""

import math

import pytest
from pydantic import TypeAdapter, ValidationError

from recalib.files import bounded
from replication.config import units


def read(kind, value):
    return TypeAdapter(kind).validate_python(value)


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


def test_a_share_is_a_bare_number():
    assert [read(bounded.Share, value) for value in (0, 0.25, 1)] == [0.0, 0.25, 1.0]
    for value in (-0.1, 1.1, "0.1", "10 %", True, None, math.nan):
        with pytest.raises(ValidationError, match=r"a number from 0 to 1, such as 0\.1"):
            read(bounded.Share, value)


@pytest.mark.parametrize("value", ["4", 4.0, 4.5, True, None, 0, units.MOST + 1])
def test_a_count_is_a_whole_number(value):
    assert read(units.Count, 1) == 1 and read(units.Count, units.MOST) == units.MOST
    with pytest.raises(ValidationError):
        read(units.Count, value)


def test_values_that_are_distinct_or_in_order():
    assert read(units.Distinct[units.Count], [2, 1]) == (2, 1)
    with pytest.raises(ValidationError, match="each once, not 3 twice"):
        read(units.Distinct[units.Count], [3, 3])
    with pytest.raises(ValidationError, match="at least 1 item"):
        read(units.SomeDistinct[units.Name], [])
    assert read(units.Ordered[units.Scale], [0.5, 0.5]) == (0.5, 0.5)
    with pytest.raises(ValidationError, match="the lower value first"):
        read(units.Ordered[bounded.Angle], ["2 deg", "1 deg"])


@pytest.mark.parametrize("name", ["10ur", "a-b", "a b", "a/b", "", "a" * 61, "é", "a\n"])
def test_a_name_can_be_a_part_of_a_path(name):
    assert read(units.Name, "Ur_10") == "Ur_10"
    with pytest.raises(ValidationError, match="a name"):
        read(units.Name, name)
