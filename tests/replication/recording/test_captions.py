"""What a recording says of itself."""

import numpy as np

from replication.scenarios import Resolved
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
        "learns for 40 iterations (80 moves)",
        first.removeprefix("before recalibration: mean errors ") + " before",
        last.removeprefix("after recalibration: mean errors ") + " after",
    ):
        assert part in text
    legend = columns("/legend", "Points3D:labels")[1][0]
    assert legend == ["desired pose", "tool", "damage", "assumed arm"]


def test_of_an_undamaged_arm_it_speaks_of_no_damage_and_no_misses(files):
    columns = reader(files.recordings[1])
    text = columns("/about", "TextDocument:text")[1][0][0]
    assert "It has no damage" in text and "miss" not in text and "yellow" not in text
    captions = columns("/improved/target/caption", "Points3D:labels")[1]
    assert captions[0][0].startswith("before learning: ")
    assert captions[-1][0].startswith("after learning: ")
    assert "damage" not in columns("/legend", "Points3D:labels")[1][0]
