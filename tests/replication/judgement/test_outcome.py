"""What is said at the end of a run: the claims that were tested, and no others."""

import pytest

from replication.config.reading import read_study
from replication.judgement.claims import CLAIMS, judging
from replication.judgement.needs import Request
from replication.pages.outcome import NEEDS, outcome
from replication.running.studies import CONFIGURATION, OTHERS, layers_of
from replication.training.trainings import Trainings
from tests.conftest import ROOT

SWITCHES = {"theta-increments", "jacobian-increments", "schedule"}


def judged(name: str) -> set[str]:
    """The claims that are judged in a study."""
    known = sorted((ROOT / OTHERS).glob("*.yaml"))
    path = next((path for path in known if path.stem == name), None)
    layers = layers_of(path, known) if path else []
    study = read_study(ROOT / CONFIGURATION, *layers)
    return {*judging(lambda: Request(study, Trainings(study), "results", str))}


@pytest.mark.parametrize(
    ("study", "beside"),
    [
        ("quick", {"identity", "initial-error"}),
        ("ur3", {"identity", "initial-error"}),
        ("bent", set()),  # neither the intact robot nor the paper's damage
        ("coarse", {"initial-error"}),
    ],
)
def test_a_study_judges_what_its_trainings_tell_of(study, beside):
    assert judged(study) == SWITCHES | {"ritter-slow", "figure-1"} | beside


def test_the_shipped_study_judges_all():
    assert judged("replication") == {claim.id for claim in CLAIMS}


def test_errors_and_verdicts_are_said_and_where_to_look(synthetic):
    evidence = synthetic.evidence(NEEDS)
    text = outcome(evidence)
    assert text.startswith("results: UR10, forearm_link 4 cm\n")
    for row in evidence.table("summary.csv").itertuples():
        assert row.scenario in text and f"{row.final_position_error_cm:.2f} cm" in text
    words = " ".join(text.split())
    verdicts = [claim["verdict"] for claim in evidence.claims()]
    assert len(verdicts) == len(CLAIMS)
    assert words.count("supported") == verdicts.count("supported") > 0
    assert "make view STUDY=results, or make web STUDY=results for a browser" in words
