"""The words for damages and disturbances in the configuration, and what they mean."""

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import TypeAdapter, ValidationError

from recalib.damaged.damage import BaseShift, EncoderShift, LinkShortening
from recalib.damaged.disturbances import Noise, Outliers, Repeatability
from recalib.damaged.kinds import DAMAGES, DISTURBANCES
from recalib.damaged.nongeometric import Backlash, EccentricGear, Sag
from replication.config.damages import Assigned, Entry, describe

ENTRY = TypeAdapter(Entry)
WORDS = [
    ({"link": "forearm_link", "shorten": "4 cm"}, LinkShortening("forearm_link", 0.04)),
    ({"link": "a", "shorten": "1 cm", "along": "axis"}, LinkShortening("a", 0.01, "axis")),
    ({"encoder": "elbow_joint", "shift": "-3 deg"}, EncoderShift("elbow_joint", -np.radians(3))),
    ({"translate": ["1 cm", "0 m", "-2 mm"]}, BaseShift(translation=(0.01, 0.0, -0.002))),
    ({"rotate": ["0 deg", "180 deg", "1 rad"]}, BaseShift(rotation=(0.0, np.pi, 1.0))),
    (
        {"gear": "elbow_joint", "eccentricity": "0.5 deg", "phase": "90 deg"},
        EccentricGear("elbow_joint", np.radians(0.5), np.pi / 2),
    ),
    ({"gear": "elbow_joint", "eccentricity": "0.1 rad"}, EccentricGear("elbow_joint", 0.1)),
    ({"sag": "elbow_joint", "compliance": "0.01 rad/Nm"}, Sag("elbow_joint", 0.01)),
    ({"backlash": "elbow_joint", "gap": "0.1 rad"}, Backlash("elbow_joint", 0.1)),
    ({"noise": {"position": "0.2 mm", "orientation": "0.1 rad"}}, Noise(0.0002, 0.1)),
    ({"repeatability": "0.1 rad"}, Repeatability(0.1)),
    ({"outliers": {"share": 0.1, "size": "5 cm"}}, Outliers(0.1, 0.05)),
    ({"assigned": "links"}, Assigned(assigned="links")),
]


@pytest.mark.parametrize(("said", "meant"), WORDS, ids=[" ".join(said) for said, _ in WORDS])
def test_words_are_read_and_written_alike(said, meant):
    assert ENTRY.validate_python(said) == meant
    assert describe(meant) == said
    assert json.loads(ENTRY.dump_json(meant)) == said


def test_a_shift_of_the_base_may_say_both():
    both = BaseShift((0.01, 0.0, 0.0), (0.0, 0.1, 0.0))
    assert ENTRY.validate_python(describe(both)) == both
    assert ENTRY.validate_python(describe(BaseShift())) == BaseShift()


def test_a_damage_is_an_entry_already():
    damage = Sag("elbow_joint", 0.01)
    assert ENTRY.validate_python(damage) is damage


@given(st.floats(0, 3), st.floats(-3, 3))
def test_no_digit_is_lost(size, angle):
    for entry in (
        LinkShortening("a", size),
        EncoderShift("a", angle),
        EccentricGear("a", 1, angle),
    ):
        assert ENTRY.validate_json(ENTRY.dump_json(entry)) == entry


def test_every_kind_is_tried_above():
    assert {type(meant) for _, meant in WORDS} == {*DAMAGES, *DISTURBANCES, Assigned}


@pytest.mark.parametrize(
    "said",
    [
        {},
        {"twist": "3 deg"},
        {"link": "a", "shorten": "1 cm", "along": "z"},
        "links",
        None,
        [],
        3,
        {3: 4},
    ],
)
def test_what_is_no_entry_is_refused(said):
    with pytest.raises(ValidationError):
        ENTRY.validate_python(said)
