"""Types of the configuration's values: what each takes, to its bounds."""

import math

import pytest
from pydantic import TypeAdapter, ValidationError

from recalib.files import bounded


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
