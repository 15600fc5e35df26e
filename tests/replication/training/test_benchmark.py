import pandas as pd

from replication.training import Timed, compete


def of(study, **update):
    plan = {"seeds": 2, "moves": (2, 4), "longer": (8, 3), "papers": {"improved": 200}} | update
    training = study.training.model_copy(update={"tests": 3})
    benchmark = study.benchmark.model_copy(update=plan)
    return study.model_copy(update={"benchmark": benchmark, "training": training})


def test_scenarios_side_by_side_are_what_each_of_them_is_alone(study):
    def competed(*scenarios):
        table = compete(of(study, scenarios=scenarios), "affine", [])
        return table.drop(columns="seconds_per_move")

    both = competed("links", "rotation")
    assert both.groupby(["scenario", "seed"])["moves"].agg(list).to_dict() == {
        (name, seed): [2, 3, 4] for name in ("links", "rotation") for seed in (0, 1)
    }
    for name in ("links", "rotation"):
        beside = both[both["scenario"] == name].reset_index(drop=True)
        pd.testing.assert_frame_equal(beside, competed(name), rtol=1e-6)


def test_a_learner_of_the_paper_moves_twice_an_iteration_by_its_settings(study, settings):
    table = compete(of(study, scenarios=("rotation",)), "improved", settings)
    assert table["moves"].tolist() == [2, 4, 8] * 2
    assert table["iteration"].tolist() == [1, 2, 4] * 2
    assert (table["learner"] == "improved").all()


def test_its_time_is_shared_by_all_moves_of_all_runs(study, monkeypatch):
    def learn(self, *_):
        self.seconds += 6.0

    monkeypatch.setattr(Timed, "learn", learn)
    table = compete(of(study, scenarios=("links",), longer=()), "affine", [])
    assert set(table["seconds_per_move"]) == {4 * 6.0 / (2 * 4)}
