"""What is known of a study beside its results is what its configuration says."""

import yaml

from recalib.study.evidence.needs import FACTS, Request
from recalib.study.plan.trainings import Trainings
from tests.conftest import ROOT


def facts(study) -> dict:
    ask = Request(study, Trainings(study), "results", str)
    return ask.read(" ".join(FACTS)).evidence.facts


def test_facts_of_the_shipped_study_are_those_of_its_file(study):
    its = yaml.safe_load((ROOT / "config.yaml").read_text(encoding="utf-8"))
    real, ladder = its["real"], its["experiments"]["ladder"]
    assert facts(study) == {
        **{name: its[name] for name in ("seed", "robot", "scenario")},
        "scenarios": its["experiments"]["scenarios"],
        "recordings": its["experiments"]["scenarios"],
        "elsewhere": {
            "ur10": "links_encoders",
            "ur5": "links_encoders-ur5",
            "z1": "links_encoders-z1",
        },
        "published": its["paper_damage"]["published"],
        "published_mm": real["published"],
        "iterations": its["learners"]["improved"]["iterations"],
        "improved": "improved",
        "ritter": "ritter",
        "short": "ritter_200",
        "compared": ["ritter_double", "improved"],
        "learners": its["experiments"]["learners"],
        "beside": [],
        "switched": [
            "improved_theta_values",
            "ritter_theta_increments",
            "improved_jacobian_values",
            "ritter_jacobian_increments",
            "improved_exponential",
            "ritter_equal_visits",
        ],
        # a training of the learner's own length has the learner's name
        "ladder": {
            name: [
                [rung, name if rung == its["learners"][name]["iterations"] else f"{name}_{rung}"]
                for rung in rungs
            ]
            for name, rungs in ladder.items()
        },
        "setups": {
            "outcomes": its["universes"]["count"],
            "horizon": its["universes"]["count"] // 2,
        },
        "rough_trials": its["universes"]["rough_trials"],
        "coupling_poses": its["mapping"]["poses"],
        **{name: its["mapping"][name] for name in ("balls", "points", "radius")},
        "assignment_poses": its["paper_damage"]["poses"],
        "short_searches": its["search"]["short"],
        "searches_long": its["search"]["searches_long"],
        **{name: its["training"][name] for name in ("tests", "measure_every")},
        "real_robot": real["robot"],
        "real_poses": real["poses"],
        "budgets": its["benchmark"]["moves"],
        "threshold": 0.1,
    }


def test_of_the_learners_beside_those_are_shown_that_train_as_long_as_the_improved_one(study):
    beside = {"beside": ("ritter_double", "ritter_double_200", "ritter_double_500")}
    more = study.model_copy(update={"experiments": study.experiments.model_copy(update=beside)})
    assert facts(more)["beside"] == ["ritter_double_200"]
