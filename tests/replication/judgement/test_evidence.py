import numpy as np
import pandas as pd
import pytest

from recalib.errors import RecalibError
from recalib.files.storage import whole
from recalib.numerics.randomness import generator
from replication.judgement.checks import check, expect, report
from replication.judgement.summary import error_at_these_settings
from replication.running.studies import BANDS


def test_generators_differ_by_key_and_repeat():
    keys = [(1, "a", 2), (2, "a", 2), (1, "b", 2), (1, "a", 3)]
    first, again = ([generator(*its).random() for its in keys] for _ in range(2))
    assert first == again and len({*first}) == len(keys)


SUMMARY = pd.DataFrame(
    {
        "scenario": ["links", "intact"],
        "learner": ["improved", "improved"],
        "final_position_error_cm": [0.25, 1e-10],
        "final_position_error_cm_se": [0.005, 1e-11],
        "final_orientation_error_deg": [0.20, 1e-10],
        "final_orientation_error_deg_se": [0.005, 1e-11],
    }
)


def test_a_band_knows_the_luck_of_seeds_and_not_that_of_searches():
    values = np.random.default_rng(0).normal(1, 0.1, (40, 5))
    found = error_at_these_settings(values)
    assert found == pytest.approx(0.1 / np.sqrt(200), rel=0.1)
    searches = np.arange(40)[:, None]
    assert error_at_these_settings(values + searches) == pytest.approx(found)


def test_results_pass_their_own_bands_and_a_change_does_not():
    bands = expect(SUMMARY)
    assert ",".join(bands.columns) == BANDS, "as they are read"
    assert check(SUMMARY, bands)["ok"].all()
    for column, value in (("final_position_error_cm", 0.30), ("final_orientation_error_deg", 0.15)):
        table = check(SUMMARY.assign(**{column: value}), bands)
        assert not table[(table["scenario"] == "links") & (table["error"] == column[6:])][
            "ok"
        ].any()


def test_what_is_negligible_only_has_to_stay_so():
    bands = expect(SUMMARY)
    intact = bands[bands["scenario"] == "intact"]
    assert intact[["low", "high"]].values.tolist() == [[0.0, 1e-3]] * 2
    table = check(SUMMARY.assign(final_position_error_cm=[0.25, 2e-3]), bands)
    assert table.loc[~table["ok"], ["scenario", "error"]].values.tolist() == [
        ["intact", "position_error_cm"]
    ]


def test_a_training_without_a_band_and_a_band_without_a_training_fail():
    bands = expect(SUMMARY)
    assert not check(SUMMARY, bands[bands["scenario"] == "links"])["ok"].all()
    assert not check(SUMMARY[:1], bands)["ok"].all()


def test_nan_is_outside_of_every_band():
    table = check(SUMMARY.assign(final_position_error_cm=np.nan), expect(SUMMARY))
    assert table["ok"].sum() == 2


def test_a_failure_names_the_row_the_value_and_the_band(tmp_path):
    summary, bands = tmp_path / "summary.csv", tmp_path / "bands.csv"
    SUMMARY.assign(final_position_error_cm=[7.0, 0]).to_csv(summary)
    expect(SUMMARY).to_csv(bands)
    with pytest.raises(
        RecalibError, match="links improved: position_error_cm is 7, expected 0.23 to 0.27"
    ):
        report(summary, bands)


def test_a_file_appears_whole_or_not_at_all(tmp_path):
    target = tmp_path / "deep" / "result.txt"

    def stopped():
        with whole(target) as path:
            path.write_text("half")
            raise RuntimeError("stop")

    with pytest.raises(RuntimeError, match="stop"):
        stopped()
    assert list(target.parent.iterdir()) == []
    with whole(target) as path:
        path.write_text("all")
        assert path.suffix == ".txt" and not target.exists()
    assert target.read_text() == "all" and len(list(target.parent.iterdir())) == 1
