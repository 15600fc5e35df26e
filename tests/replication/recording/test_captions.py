"""What a recording says of itself."""

import numpy as np
import pytest

from recalib.damaged.bending import LinkBend
from recalib.damaged.damage import BaseShift, EncoderShift, LinkShortening
from recalib.damaged.disturbances import Noise
from replication.recording.naming import in_words
from replication.scenarios.plants import Resolved
from tests.replication.recording.conftest import reader


def test_it_keeps_its_scenario_and_what_made_it(columns, resolved):
    def kept(key):
        return columns("/__properties/run", key)[1][0][0]

    assert Resolved.model_validate_json(kept("scenario")) == resolved
    assert kept("numpy") == np.__version__


def test_it_explains_the_arm_its_damage_and_what_came_of_it(columns):
    text = columns("/about", "TextDocument:text")[1][0][0]
    times, captions = columns("/improved/target/caption", "Points3D:labels")
    first, last = captions[0][0], captions[-1][0]
    assert first.startswith("before recalibration: mean errors ") and times[0] < 0 < times[-1]
    assert last.startswith("after recalibration: mean errors ")
    for part in (
        "a UR10",
        "forearm: 4 cm short; elbow: encoder -4 deg; shoulder lift: compliance 0.0002 rad/Nm",
        "position noise 0.2 mm",
        "10 measurements of it, 100 times enlarged",
        "learns for 40 iterations (80 moves)",
        first.removeprefix("before recalibration: mean errors ") + " before",
        last.removeprefix("after recalibration: mean errors ") + " after",
    ):
        assert part in text
    legend = columns("/legend", "Points3D:labels")[1][0]
    assert legend == ["desired pose", "pose reached", "measurement", "damage", "assumed arm"]
    beside = columns("/beside", "TextDocument:text")[1][0][0]
    assert "**geometric** (an identified model) learns for 5 iterations (5 moves)" in beside


def test_of_an_undamaged_arm_it_speaks_of_no_damage_and_no_misses(files):
    columns = reader(files.recordings[1])
    text = columns("/about", "TextDocument:text")[1][0][0]
    assert "It has no damage" in text and "miss" not in text and "yellow" not in text
    captions = columns("/improved/target/caption", "Points3D:labels")[1]
    assert captions[0][0].startswith("before learning: ")
    assert captions[-1][0].startswith("after learning: ")
    assert "damage" not in columns("/legend", "Points3D:labels")[1][0]


@pytest.mark.parametrize(
    ("entry", "words"),
    [
        (LinkShortening("forearm_link", 0.04), "forearm: 4 cm short"),
        (LinkShortening("wrist_1_link", 0.01, "axis"), "wrist 1: 1 cm short, along axis"),
        (EncoderShift("wrist_2_joint", np.radians(-3)), "wrist 2: encoder -3 deg"),
        (LinkBend("upper_arm_link", np.radians(5)), "upper arm: bend 5 deg"),
        (BaseShift((0.01, 0, 0)), "translate 1 cm, 0 m, 0 m"),
        (Noise(0.0003, 0.001), "position noise 0.3 mm, orientation noise 0.001 rad"),
    ],
)
def test_a_damage_is_told_in_the_words_of_the_configuration(entry, words):
    assert in_words(entry) == words
