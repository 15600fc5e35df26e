"""What is written for damages and disturbances in a configuration, and what it means."""

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import TypeAdapter

from recalib import (
    Backlash,
    BaseShift,
    EccentricGear,
    EncoderShift,
    LinkBend,
    LinkShortening,
    LinkTwist,
    Noise,
    Outliers,
    Repeatability,
    Sag,
)
from replication.config import Assigned, Entry, describe

ENTRY = TypeAdapter(Entry)
WRITTEN = [
    ({"link": "forearm_link", "shorten": "4 cm"}, LinkShortening("forearm_link", 0.04)),
    ({"link": "a", "shorten": "1 cm", "along": "axis"}, LinkShortening("a", 0.01, "axis")),
    ({"link": "a", "bend": "-4 deg"}, LinkBend("a", -np.radians(4))),
    ({"link": "a", "bend": "0.1 rad", "towards": "2 rad"}, LinkBend("a", 0.1, 2.0)),
    ({"link": "a", "twist": "0.1 rad"}, LinkTwist("a", 0.1)),
    ({"encoder": "elbow_joint", "shift": "-3 deg"}, EncoderShift("elbow_joint", -np.radians(3))),
    ({"translate": ["1 cm", "0 m", "-2 mm"]}, BaseShift(translate=(0.01, 0.0, -0.002))),
    ({"rotate": ["0 deg", "180 deg", "1 rad"]}, BaseShift(rotate=(0.0, np.pi, 1.0))),
    (
        {"joint": "elbow_joint", "eccentricity": "0.5 deg", "phase": "90 deg"},
        EccentricGear("elbow_joint", np.radians(0.5), np.pi / 2),
    ),
    ({"joint": "elbow_joint", "eccentricity": "0.1 rad"}, EccentricGear("elbow_joint", 0.1)),
    ({"joint": "elbow_joint", "compliance": "0.01 rad/Nm"}, Sag("elbow_joint", 0.01)),
    ({"joint": "elbow_joint", "gap": "0.1 rad"}, Backlash("elbow_joint", 0.1)),
    ({"position_noise": "0.2 mm", "orientation_noise": "0.1 rad"}, Noise(0.0002, 0.1)),
    ({"position_noise": "0.2 mm"}, Noise(0.0002)),
    ({"repeatability": "0.1 rad"}, Repeatability(0.1)),
    ({"outlier_share": 0.1, "outlier_size": "5 cm"}, Outliers(0.1, 0.05)),
    ({"assigned": "links"}, Assigned(assigned="links")),
]


@pytest.mark.parametrize(("text", "entry"), WRITTEN, ids=[" ".join(text) for text, _ in WRITTEN])
def test_entries_are_written_as_they_are_read(text, entry):
    assert ENTRY.validate_python(text) == entry
    assert describe(entry) == text
    assert json.loads(ENTRY.dump_json(entry)) == text
    assert ENTRY.validate_json(ENTRY.dump_json(entry)) == entry


def test_a_shift_of_the_base_may_say_both():
    both = BaseShift((0.01, 0.0, 0.0), (0.0, 0.1, 0.0))
    assert ENTRY.validate_python(describe(both)) == both
    assert ENTRY.validate_python(describe(BaseShift())) == BaseShift()
    assert describe(Noise(0.0002, 1.0 - 1.0)) == {"position_noise": "0.2 mm"}


@given(st.floats(0, 3), st.floats(-3, 3))
def test_no_digit_is_lost(size, angle):
    damages = LinkShortening("a", size), EncoderShift("a", angle), EccentricGear("a", 1, angle)
    for damage in damages:
        assert ENTRY.validate_json(ENTRY.dump_json(damage)) == damage
