"""What claims, figures and pages read of a study, and what it lacks."""

from operator import methodcaller

import pandas as pd
import pytest

from replication.judgement import Evidence, NotMeasured
from replication.running import write
from replication.training import ERRORS
from tests.conftest import changed


@pytest.fixture
def evidence(study, tmp_path):
    """With a history of two trainings of two seeds, in no order."""
    rows = [
        {"iterations": iterations, "seed": seed, "iteration": iteration}
        | {ERRORS[0]: 100 * seed + iteration, ERRORS[1]: float(iterations)}
        for seed in (1, 0)
        for iterations in (200, 500)
        for iteration in (iterations, 0)
    ]
    write(tmp_path / "results/runs/ur10/links_encoders/improved.parquet", pd.DataFrame(rows))
    return Evidence(study, tmp_path)


def test_a_history_is_that_of_one_length_and_errors_its_first_or_last_ones_by_seed(evidence):
    assert set(evidence.history("improved", 500)["iteration"]) == {0, 500}
    assert evidence.errors("improved", 200).tolist() == [[200, 200], [300, 200]]
    assert evidence.errors("improved", 200, first=True).tolist() == [[0, 200], [100, 200]]


@pytest.mark.parametrize(
    ("ask", "key"),
    [
        (methodcaller("history", "improved", 201), r"experiments\.learners\.improved: \[201\]"),
        (methodcaller("history", "improved", 200, "gears"), r"learners\.improved: \[200\]"),
        (methodcaller("mapping", "widths"), "mapping/widths.parquet"),
        (methodcaller("outcomes"), "workflow/campaign/outcomes.csv"),
        (methodcaller("assignments"), "assignments/ur10.parquet"),
        (methodcaller("findings"), "claims.json"),
    ],
)
def test_what_a_study_lacks_is_named(evidence, ask, key):
    with pytest.raises(NotMeasured, match=key):
        ask(evidence)


def test_the_campaign_is_that_of_the_shipped_study(study, tmp_path):
    write(tmp_path / "workflow/campaign/outcomes.csv", pd.DataFrame({"setup": [0]}))
    assert len(Evidence(study, tmp_path).outcomes()) == 1
    with pytest.raises(NotMeasured, match="name: replication"):
        Evidence(changed(study, name="mine"), tmp_path).outcomes()
