"""What the other pages say, beside what one counts by hand."""

from types import SimpleNamespace

import pandas as pd
import pytest

from recalib.study.evidence.all_results import _on_its_way
from recalib.study.inference.measured import ERRORS


@pytest.mark.parametrize(
    ("last", "text"),
    [
        ([2.0, 3.0], "after 1,000 iterations"),  # both are within there, one was before
        ([0.5, 3.0], "in none of its 5,000 iterations"),
    ],
)
def test_ritters_is_said_to_have_both_errors_of_the_improved_one_on_its_way(last, text):
    ours = pd.DataFrame([[9.0, 9.0, 0], [*last, 200]], columns=[*ERRORS, "iteration"])
    # of two seeds: what counts is their mean
    ritters = pd.DataFrame(
        [[9, 9, 0], [1, 4, 100], [3, 4, 100], [1, 2, 1000], [3, 4, 1000], [1, 1, 5000]],
        columns=[*ERRORS, "iteration"],
    )
    histories = {"improved": ours, "ritter_own": ritters}
    roles = {"improved": "improved", "ritter": "ritter_own"}
    assert _on_its_way(SimpleNamespace(history=histories.get, facts=roles)) == text
