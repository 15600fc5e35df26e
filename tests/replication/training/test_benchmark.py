import pandas as pd

from replication.training import compete


def of(study, **update):
    plan = {"seeds": 2, "moves": (2, 4), "longer": (8, 3), "papers": {"improved": 200}} | update
    training = study.training.model_copy(update={"tests": 3})
    benchmark = study.benchmark.model_copy(update=plan)
    return study.model_copy(update={"benchmark": benchmark, "training": training})


def test_scenarios_side_by_side_are_what_each_of_them_is_alone(study):
    def competed(*scenarios):
        return compete(of(study, scenarios=scenarios), "affine", [])

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
