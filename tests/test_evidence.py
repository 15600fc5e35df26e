import numpy as np
import pandas as pd
import pytest

from recalib.randomness import generator
from recalib.storage import whole
from recalib.study.evidence.checks import CheckFailed, check, expect
from recalib.study.statistics import bootstrap, first_within


def test_the_interval_covers_the_mean_as_often_as_it_says():
    covered = 0
    for repetition in range(200):
        values = np.random.default_rng(repetition).normal(3.0, 1.0, 30)
        estimate = bootstrap(values, np.random.default_rng(0))
        assert estimate.low < estimate.mean < estimate.high
        covered += estimate.low <= 3.0 <= estimate.high
    assert (
        178 <= covered <= 198
    )  # 95 % less the known optimism of the percentile bootstrap at 30 values


def test_one_seed_has_no_interval():
    estimate = bootstrap([2.0], np.random.default_rng(0))
    assert estimate.mean == 2.0 and np.isnan(estimate.low)


def test_a_threshold_counts_where_all_errors_are_within():
    iterations, errors = np.array([0, 10, 20]), np.array([[3, 3], [1, 3], [1, 1.0]])
    assert first_within(iterations, errors, np.array([1, 2])) == 20
    assert first_within(iterations, errors, np.array([0.5, 2])) == np.inf


def test_generators_differ_by_key_and_repeat():
    assert generator(1, "a", 2).random() == generator(1, "a", 2).random()
    assert (
        len(
            {
                generator(*keys).random()
                for keys in [(1, "a", 2), (2, "a", 2), (1, "b", 2), (1, "a", 3)]
            }
        )
        == 4
    )


SUMMARY = pd.DataFrame(
    {
        "scenario": ["links", "intact"],
        "learner": ["improved", "improved"],
        "final_position_error_cm": [0.25, 1e-10],
        "final_position_error_cm_low": [0.24, 1e-11],
        "final_position_error_cm_high": [0.26, 1e-9],
        "final_orientation_error_deg": [0.20, 1e-10],
        "final_orientation_error_deg_low": [0.19, 1e-11],
        "final_orientation_error_deg_high": [0.21, 1e-9],
    }
)


def test_results_pass_their_own_bands_and_a_change_does_not():
    bands = expect(SUMMARY)
    assert check(SUMMARY, bands)["ok"].all()
    for column, value in (("final_position_error_cm", 0.30), ("final_orientation_error_deg", 0.15)):
        table = check(SUMMARY.assign(**{column: value}), bands)
        assert not table[(table["scenario"] == "links") & (table["error"] == column[6:])][
            "ok"
        ].any()


def test_what_is_negligible_only_has_to_stay_so():
    bands = expect(SUMMARY)
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


def test_a_failure_names_the_row_the_value_and_the_band():
    table = check(SUMMARY.assign(final_position_error_cm=[7.0, 0]), expect(SUMMARY))
    with pytest.raises(
        CheckFailed, match="links improved: position_error_cm is 7, expected 0.2296 to 0.2704"
    ):
        raise CheckFailed(table[~table["ok"]])


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
