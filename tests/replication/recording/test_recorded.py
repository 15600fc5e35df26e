"""Which trainings are recorded."""

import pandas as pd

from replication.recording import recorded_places
from replication.recording.recorded import recorded_history
from replication.training import leading


def test_every_scenario_is_recorded_with_the_training_of_figure_1(study, tmp_path):
    learners = {"ritter_double": (500,), "improved": (100, 200, 500), "ritter": (200,)}
    plan = study.experiments.model_copy(update={"learners": learners})
    planned = study.model_copy(update={"experiments": plan})
    assert leading(planned) == ("improved", 200, "links_encoders")
    assert [place.scenario for place in recorded_places(planned)] == [*plan.scenarios]
    pd.DataFrame({"iterations": learners["improved"]}).to_parquet(path := tmp_path / "history")
    assert recorded_history(planned, path)["iterations"].tolist() == [200]
    assert {place.robot for place in recorded_places(planned)} == {study.robot}
