"""Which trainings are recorded."""

import pandas as pd

from replication.recording import (
    published_errors,
    recorded_iterations,
    recorded_learners,
    recorded_places,
    typical_seed,
)


def test_every_scenario_is_recorded_with_the_learners_of_the_shortest_training(study):
    learners = {"improved": (200, 500), "ritter": (200,), "ritter_double": (500,)}
    plan = study.experiments.model_copy(update={"learners": learners})
    its = study.model_copy(update={"experiments": plan})
    assert recorded_iterations(its) == 200
    assert recorded_learners(its) == ["improved", "ritter"]
    assert [place.scenario for place in recorded_places(its)] == [*plan.scenarios]
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
