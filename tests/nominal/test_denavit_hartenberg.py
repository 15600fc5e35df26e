"""Tables of Denavit-Hartenberg parameters against closed forms, their products and a URDF."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from recalib import Row, arm_of_table
from replication.scenarios import nominal_robot


def turn(axis: int, angle: float) -> np.ndarray:
    c, s, matrix = np.cos(angle), np.sin(angle), np.eye(4)
    one, other = (axis + 1) % 3, (axis + 2) % 3
    matrix[[one, one, other, other], [one, other, one, other]] = c, -s, s, c
    return matrix


def slide(axis: int, length: float) -> np.ndarray:
    matrix = np.eye(4)
    matrix[axis, 3] = length
    return matrix


# Of the PUMA 560 (Corke, Armstrong-Helouvry 1994), with its flange: d, a, alpha.
PUMA = (
    (0.0, 0.0, np.pi / 2),
    (0.0, 0.4318, 0.0),
    (0.15005, 0.0203, -np.pi / 2),
    (0.4318, 0.0, np.pi / 2),
    (0.0, 0.0, -np.pi / 2),
    (0.05625, 0.0, 0.0),
)

NUMBERS = st.floats(-2, 2)
ROWS = st.lists(
    st.builds(Row, st.just(""), NUMBERS, NUMBERS, NUMBERS, NUMBERS, st.booleans()),
    min_size=1,
    max_size=8,
)


@given(rows=ROWS, angle=NUMBERS)
@pytest.mark.parametrize("convention", ["standard", "modified"])
def test_the_tool_is_where_the_product_of_the_rows_says(convention, rows, angle):
    rows = [Row(f"j{i}", r.a, r.alpha, r.d, r.theta, r.slides) for i, r in enumerate(rows)]
    arm, expected = arm_of_table(rows, convention), np.eye(4)
    for row in rows:
        turned, slid = angle * (not row.slides), angle * row.slides
        along_z = turn(2, row.theta + turned) @ slide(2, row.d + slid)
        along_x = turn(0, row.alpha) @ slide(0, row.a)
        parts = (along_z, along_x) if convention == "standard" else (along_x, along_z)
        expected = expected @ parts[0] @ parts[1]
    assert np.allclose(arm.forward(np.full((1, len(rows)), angle))[0], expected, atol=1e-12)
    assert arm.joints == tuple(row.name for row in rows) and arm.massless
    assert arm.slides.tolist() == [row.slides for row in rows]


def test_the_puma_moves_as_its_published_table_says_and_has_a_spherical_wrist(plan):
    arm = nominal_robot(plan.nominal("puma560")).arm
    rows = [Row(str(n), a=a, alpha=alpha, d=d) for n, (d, a, alpha) in enumerate(PUMA)]
    angles = np.random.default_rng(0).uniform(-3, 3, (20, 6))
    assert np.allclose(arm.forward(angles), arm_of_table(rows).forward(angles), atol=1e-12)
    turned = np.concatenate([angles[:, :3], np.roll(angles[:, 3:], 1, axis=0)], axis=1)
    wrist, same = (arm.skeleton(posture)[:, 5:7] for posture in (angles, turned))
    assert np.allclose(wrist, wrist[:, :1], atol=1e-12) and np.allclose(wrist, same, atol=1e-12)
