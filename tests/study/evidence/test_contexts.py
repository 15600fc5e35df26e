"""What the other pages say, beside what one counts by hand."""

from types import SimpleNamespace

import pandas as pd
import pytest

from recalib.study.evidence import choices, guidance
from recalib.study.evidence.all_results import _on_its_way
from recalib.study.inference.measured import ERRORS


def test_choices_say_how_much_was_searched(made_up):
    """A hundred trials of each search were made up, and 41 assignments."""
    said = choices.context(made_up.evidence(choices.NEEDS))
    assert said == {
        "setups": 64,
        "damages": "forearm_link 4 cm",
        "assignments": 41,
        "translation": "5 cm, -5 cm, 4.3 cm",
        "rotation": "2 deg, -3 deg, 3 deg",
        "trials": 100,
        "searches": 4,
        "short": 500,
        "searches_long": 3,
    }


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
    assert _on_its_way(SimpleNamespace(history=histories.get, fact=roles.get)) == text


def test_guidance_says_of_what_it_is_and_where_the_hybrid_is_not_the_best(made_up, few):
    said = guidance.context(made_up.evidence(guidance.NEEDS))
    assert said["learners"] == list(few.benchmark.learners)
    assert said["scenarios"] == list(few.benchmark.scenarios)
    assert (said["seeds"], said["threshold"], said["budget"]) == (4, 0.1, 400)
    assert (said["first"], said["percent"], said["negligible"]) == (4, "10", 1e-4)
    assert not said["shipped"] and said["worse"] is not None
