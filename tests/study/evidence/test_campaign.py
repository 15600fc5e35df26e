"""The campaign is read whole or not at all, and by the shipped study alone."""

from pathlib import Path

import pytest

from recalib.study.evidence.results import Evidence, Undeclared
from recalib.study.layout import PIECES, REFERENCE, SECOND, Layout, pieces
from tests.made_up import MadeUp


def asked(made_up: MadeUp):
    ask = made_up.request()
    for table in PIECES:
        ask.setups(table)
    return ask.needs


def test_no_table_is_read_before_the_last_piece_is_in(few, tmp_path):
    made_up = MadeUp(tmp_path, few)
    for table in PIECES:
        assert Evidence(asked(made_up)).setups(table) is None
    made_up.campaign()
    read = {table: Evidence(asked(made_up)).setups(table) for table in PIECES}
    assert len(read["outcomes"]) == few.universes.count * few.universes.replicates
    assert len(read["horizon"]) == len(few.universes.horizons) * few.universes.replicates
    assert not read["outcomes"].duplicated(["universe", "replicate"]).any()
    last = pieces("horizon", len(few.universes.horizons), made_up.layout.shipped(SECOND))[-1]
    Path(last).unlink()
    assert Evidence(asked(made_up)).setups("horizon") is None
    assert len(Evidence(asked(made_up)).setups("outcomes")) == len(read["outcomes"])


def test_a_piece_that_was_not_declared_is_missed(few, tmp_path):
    made_up = MadeUp(tmp_path, few).campaign()
    needs = asked(made_up)
    paths = pieces("horizon", len(few.universes.horizons), made_up.layout.shipped(SECOND))
    declared = [path for path in paths if path in needs.files]
    assert len(declared) > 1, "a table of one piece is there or not"
    less = needs.model_copy(update={"files": tuple({*needs.files} - {declared[0]})})
    with pytest.raises(Undeclared, match=declared[0]):
        Evidence(less).setups("horizon")


def test_tables_are_those_of_the_project_whose_results_are_read():
    assert Layout("results").shipped(REFERENCE) == REFERENCE
    assert Layout("results/studies/my_results").shipped(REFERENCE) == REFERENCE
    assert Layout("/there/results").shipped(REFERENCE) == f"/there/{REFERENCE}"


def test_another_study_has_no_campaign(few, tmp_path):
    other = MadeUp(tmp_path, few.model_copy(update={"name": "other"})).campaign()
    ask = other.request()
    for table in PIECES:
        ask.setups(table)
    assert ask.needs.files == ()
    assert not ask.foreign
    ask.reference()
    assert ask.foreign and not ask.lacking, "it is known of the shipped study alone"
