"""What is read of a study: its facts, and the campaign whole or not at all."""

import pytest

from replication.config.shipped import PIECES, REFERENCE, pieces
from replication.judgement.needs import FACTS, Request
from replication.judgement.results import Evidence
from replication.training.trainings import Trainings
from tests.synthetic import Synthetic, without_one


def asked(synthetic: Synthetic) -> Evidence:
    return synthetic.request().read("outcomes? horizon?").evidence


def test_no_table_is_read_before_the_last_piece_is_in(few, tmp_path):
    synthetic = Synthetic(tmp_path, few)
    for table in PIECES:
        assert asked(synthetic).setups(table) is None
    synthetic.campaign()
    read = {table: asked(synthetic).setups(table) for table in PIECES}
    assert len(read["outcomes"]) == few.universes.count * few.universes.replicates
    assert len(read["horizon"]) == len(few.universes.horizons) * few.universes.replicates
    assert not read["outcomes"].duplicated(["universe", "replicate"]).any()
    synthetic.path(pieces("horizon", len(few.universes.horizons))[-1]).unlink()
    assert asked(synthetic).setups("horizon") is None
    assert len(asked(synthetic).setups("outcomes")) == len(read["outcomes"])


def test_a_piece_that_was_not_declared_is_missed(few, tmp_path):
    synthetic = Synthetic(tmp_path, few).campaign()
    evidence = asked(synthetic)
    names = pieces("horizon", len(few.universes.horizons))
    declared = [name for name in names if name in evidence.files]
    assert len(declared) > 1, "a table of one piece is there or not"
    less = dict(without_one(evidence))[declared[0]]
    with pytest.raises(KeyError, match=declared[0]):
        less.setups("horizon")


@pytest.mark.parametrize(
    ("root", "project"),
    [("results", ""), ("results/studies/my_results", ""), ("/there/results", "/there/")],
)
def test_tables_are_those_of_the_project_whose_results_are_read(few, root, project):
    ask = Request(few, Trainings(few), root, str).read(REFERENCE)
    assert ask.evidence.files[REFERENCE] == f"{project}{REFERENCE}"


def test_another_study_has_no_campaign(few, tmp_path):
    other = Synthetic(tmp_path, few.model_copy(update={"name": "other"})).campaign()
    ask = other.request().read(f"outcomes? horizon? {REFERENCE}?")
    assert ask.evidence.files == {}
    assert not ask.foreign
    ask.read(REFERENCE)
    assert ask.foreign and not ask.lacking, "it is known of the shipped study alone"


def facts(study) -> dict:
    ask = Request(study, Trainings(study), "results", str)
    return ask.read(" ".join(FACTS)).evidence.facts


def test_trainings_go_by_their_role_in_the_paper(study):
    """Others are keys of the configuration; kept pages have them."""
    own = {name: learner.iterations for name, learner in study.learners.items()}
    roles = {
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
