"""Which trainings are recorded."""

from replication.recording import recorded_places
from replication.training import leading


def test_every_scenario_is_recorded_with_the_training_of_figure_1(study):
    learners = {"ritter_double": (500,), "improved": (200, 500), "ritter": (200,)}
    plan = study.experiments.model_copy(update={"learners": learners})
    planned = study.model_copy(update={"experiments": plan})
    assert leading(planned) == ("improved", 200, "links_encoders")
    assert [place.scenario for place in recorded_places(planned)] == [*plan.scenarios]
    assert {place.robot for place in recorded_places(planned)} == {study.robot}
