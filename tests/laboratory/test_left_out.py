"""What is left out of the errors is said next to them."""

import numpy as np
import pytest

from recalib.identification import BLOCKWISE, WAYS
from recalib.laboratory.calibrate import calibrate_arm
from recalib.laboratory.report.summary import errors_table, summary
from tests.laboratory.conftest import NOISE, postures, table, true_positions, write

ROWS = 60


@pytest.fixture
def with_outliers(arm, folder):
    joints = postures(3, ROWS)
    positions = true_positions(arm, joints)
    positions += NOISE * np.random.default_rng(4).standard_normal((ROWS, 3))
    positions[[7, 30, 31, 44]] += np.random.default_rng(5).normal(0, 0.02, (4, 3))
    write(folder / "rows.csv", table(arm, joints, positions))
    return calibrate_arm(folder / "arm.urdf", folder / "rows.csv")


def test_the_first_line_and_the_table_say_how_many_rows_are_left_out(with_outliers):
    _, first, *lines = summary(with_outliers).splitlines()
    assert f"4 of {ROWS} rows left out as outliers" in first
    (row,) = [line for line in lines if line.startswith("left out")]
    largest = errors_table(with_outliers)[-1].largest
    assert "4 rows" in row and f"{largest:.3f}" in row and largest > 10


def test_95_percent_is_one_number_wherever_it_is_said(with_outliers):
    text, validation = summary(with_outliers), with_outliers.validation
    (used,) = [
        row
        for row in errors_table(with_outliers)
        if row.chosen and row.folds == BLOCKWISE and row.unit == "mm"
    ]
    assert used.within == pytest.approx(1e3 * validation.radius)
    assert text.count(f"95 % within {used.within:.3g} mm") == 2


def test_a_part_without_which_a_direction_is_open_does_not_count(arm, folder):
    """All postures that turn the last joint are near one another."""
    joints = postures(3, ROWS)
    joints[:48, 1:] = joints[0, 1:] + 1e-3 * (joints[:48, 1:] - joints[0, 1:])
    joints[48:, 0] = 3 * np.sign(joints[48:, 0].mean()) + 0.1 * joints[48:, 0]
    positions = true_positions(arm, joints)
    positions += NOISE * np.random.default_rng(4).standard_normal((ROWS, 3))
    write(folder / "rows.csv", table(arm, joints, positions))
    result = calibrate_arm(folder / "arm.urdf", folder / "rows.csv")
    lost = {way: int(result.validation.lost[way].sum()) for way in WAYS}
    assert 0 < lost[BLOCKWISE] < ROWS
    assert f"errors {BLOCKWISE} exclude {lost[BLOCKWISE]} rows" in summary(result)
    assert len(result.counted) == ROWS - lost[BLOCKWISE]
