"""What pages say of numbers and claims, word for word."""

import pytest

from recalib.study.evidence import words
from recalib.study.measured import ERRORS


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0.00"),
        (0.694, "0.69"),
        (12.5, "12.50"),
        (0.01, "0.01"),
        (0.00994, "9.9e-03"),
        (-0.004, "-4.0e-03"),
        (1e-6, "1.0e-06"),
        (9.9e-7, "below 1e-6"),
        (-3e-12, "below 1e-6"),
    ],
)
def test_a_number_has_two_digits_and_what_rounding_leaves_none(value, text):
    assert words.n(value) == text


def test_digits_may_be_asked_for():
    assert words.n(1.26, 1) == "1.3" and words.n(0.04, 1) == "4.0e-02" and words.n(2.6, 0) == "3"


def test_a_pair_is_both_errors_with_their_units():
    row = {f"final_{error}": value for error, value in zip(ERRORS, (0.126, 3e-9), strict=True)}
    assert words.pair(row, "final") == "0.13 cm, below 1e-6 degrees"


def share(holds=100, times=1.5, chance=1.2, to="urdf"):
    its = {"factor": "rate_law", "from": "paper", "to": to, "times": times, "chance": chance}
    return {"holds": holds, "of": 128, "depends_on": its | {"interval": [1.32, 1.78]}}


OF_ONE = {
    "verdict": "supported",
    "measured": {"factor": 33.24, "difference": 2e-8, "final cm": 0.3149, "final degrees": 0.2},
    "interval": {"factor": [20.1, None], "difference": [0.0, 1e-7]},
    "universes": share(),
    "systems": {},
}
OF_TWO = OF_ONE | {
    "verdict": "not supported",
    "systems": {
        "ours": {"verdict": "not supported", "universes": share(40, times=1.1)},
        "Ritter's": {"verdict": "undecided", "universes": share(87, times=1)},
    },
}


def test_what_was_measured_is_said_with_its_interval():
    factor, difference = "factor: 33.2 (20.1 to more)", "difference: below 1e-6 (0 to below 1e-6)"
    assert words.brief(OF_ONE) == factor
    assert words.measured(OF_ONE) == (
        f"{factor}; {difference}; final cm: 0.315; final degrees: 0.2"
    )
    assert words.typical_errors(OF_ONE) == "0.31 cm and 0.20 degrees"


def test_a_verdict_is_said_of_each_system_where_they_differ():
    assert words.verdicts(OF_ONE) == "**supported**"
    said = "**not supported** (not supported for ours, undecided for Ritter's)"
    assert words.verdicts(OF_TWO) == said
    ours = OF_TWO["systems"]["ours"]
    assert words.verdicts(OF_TWO | {"systems": {"ours": ours}}) == "**not supported**"


def test_in_how_many_universes_a_claim_holds_is_said_of_each_system():
    assert words.in_universes(OF_ONE) == "100 of 128"
    assert words.in_universes(OF_TWO) == "40 of 128 (ours), 87 of 128 (Ritter's)"
    assert words.in_universes(OF_ONE | {"universes": None}) == "cannot vary"


def test_a_choice_is_said_to_matter_where_it_matters_more_than_chance():
    text = "rate law, 1.5 times (1.32 to 1.78) as large for urdf as for paper"
    assert words.depends(OF_ONE) == text
    weak = "no choice, by more than chance would show"
    assert words.depends(OF_TWO) == f"ours: {weak}; Ritter's: none, it is the same in all"
    assert words.depends(OF_ONE | {"universes": share(times=1.2)}) == weak


def test_a_damage_is_its_amounts():
    entry = {"link": "forearm_link", "shorten": "4 cm", "rotate": ["1 deg", "0 deg"]}
    assert words.amounts(entry) == "forearm_link 4 cm 1 deg, 0 deg"
