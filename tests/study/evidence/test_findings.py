"""What the page of findings says; that it is written as the claims have it, other tests show."""

import pandas as pd

from recalib.study.evidence.findings import _refused


def test_refused_moves_are_said_by_learner_and_scenario_and_none_is_said_as_none():
    summary = pd.DataFrame(
        {
            "scenario": ["intact", "gears"],
            "learner": ["improved", "ritter"],
            "moves": [400, 400],
            "seeds": [5, 5],
            "refused": [0, 3],
        }
    )
    assert _refused(summary) == "3 of 2,000 for ritter on gears"
    assert _refused(summary[:1]) == "none"
