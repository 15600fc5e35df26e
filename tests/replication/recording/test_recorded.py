"""Which trainings are recorded."""

import pandas as pd

from replication.recording import recorded_places, typical_seed
from replication.training import leading


def test_every_scenario_is_recorded_with_the_training_of_figure_1(study):
    learners = {"ritter_double": (500,), "improved": (200, 500), "ritter": (200,)}
    plan = study.experiments.model_copy(update={"learners": learners})
    planned = study.model_copy(update={"experiments": plan})
    assert leading(planned) == ("improved", 200, "links_encoders")
    assert [place.scenario for place in recorded_places(planned)] == [*plan.scenarios]
    assert {place.robot for place in recorded_places(planned)} == {study.robot}


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
