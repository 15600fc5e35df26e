"""What is known of a study beside its results is what its configuration says."""

from recalib.study.evidence.needs import FACTS, Request
from recalib.study.plan.trainings import Trainings


def facts(study) -> dict:
    ask = Request(study, Trainings(study), "results", str)
    return ask.read(" ".join(FACTS)).evidence.facts


def test_trainings_go_by_their_role_in_the_paper(study):
    """Others are keys of the configuration; kept pages have them."""
    own = {name: learner.iterations for name, learner in study.learners.items()}
    roles = {
        "recordings": [*study.experiments.scenarios],
        "elsewhere": {
            "ur10": "links_encoders",
            "ur5": "links_encoders-ur5",
            "z1": "links_encoders-z1",
        },
        "improved": "improved",
        "ritter": "ritter",
        "short": "ritter_200",
        "compared": ["ritter_double", "improved"],
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
                (rung, name if rung == own[name] else f"{name}_{rung}") for rung in sorted(rungs)
            ]
            for name, rungs in study.experiments.ladder.items()
        },
        "setups": {"outcomes": study.universes.count, "horizon": study.universes.count // 2},
        "threshold": 0.1,
    }
    assert facts(study) == facts(study) | roles


def test_of_the_learners_beside_those_are_shown_that_train_as_long_as_the_improved_one(study):
    beside = {"beside": ("ritter_double", "ritter_double_200", "ritter_double_500")}
    more = study.model_copy(update={"experiments": study.experiments.model_copy(update=beside)})
    assert facts(more)["beside"] == ["ritter_double_200"]
