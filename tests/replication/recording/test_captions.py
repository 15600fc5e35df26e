"""Which trainings are recorded, and what a recording says of itself."""

import numpy as np
import pandas as pd

from replication.recording import (
    published_errors,
    recorded_iterations,
    recorded_learners,
    recorded_places,
    typical_seed,
)
from replication.scenarios import Resolved
from tests.conftest import changed
from tests.replication.recording.conftest import reader


def test_it_explains_the_arm_its_damage_and_what_came_of_it(columns, resolved):
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

    def kept(key):
        return columns("/__properties/run", key)[1][0][0]

    assert Resolved.model_validate_json(kept("scenario")) == resolved
    assert kept("numpy") == np.__version__


def test_of_an_undamaged_arm_it_speaks_of_no_damage_and_no_misses(files):
    columns = reader(files.recordings[1])
    text = columns("/about", "TextDocument:text")[1][0][0]
    assert "It has no damage" in text and "miss" not in text and "yellow" not in text
    captions = columns("/improved/target/caption", "Points3D:labels")[1]
    assert captions[0][0].startswith("before learning: ")
    assert captions[-1][0].startswith("after learning: ")
    assert "damage" not in columns("/legend", "Points3D:labels")[1][0]


def test_every_scenario_is_recorded_with_the_learners_of_the_shortest_training(study):
    learners = {"improved": (200, 500), "ritter": (200,), "ritter_double": (500,)}
    its = changed(study, experiments={"learners": learners})
    assert recorded_iterations(its) == 200
    assert recorded_learners(its) == ["improved", "ritter"]
    assert [place.scenario for place in recorded_places(its)] == [*study.experiments.scenarios]
    assert {place.robot for place in recorded_places(its)} == {study.robot}


def test_the_typical_training_ends_with_the_median_error():
    """Of 0.1, 0.4 and 0.2 at the end, 0.2: that of seed 7, which is the worst at first."""
    table = pd.DataFrame(
        {
            "seed": [5, 5, 6, 6, 7, 7],
            "iteration": [0, 40] * 3,
            "position_error_cm": [1.0, 0.1, 1.0, 0.4, 3.0, 0.2],
        }
    )
    assert typical_seed(table) == 7


def test_the_published_errors_belong_to_the_papers_damage_alone(study, small):
    published = {"position_error_cm": 8.3, "orientation_error_deg": 4.7}  # section 7
    assert published_errors(study, "links_encoders") == published
    assert published_errors(study, "links") == {}, "a part of it"
    assert published_errors(small, "links_encoders") == {}, "another damage"
