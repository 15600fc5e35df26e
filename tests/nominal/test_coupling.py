"""Joints that follow others: one column moves all of them."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from recalib import UnsuitableRobot
from recalib.nominal import arm_of
from tests.arms import urdf

GAIN = st.floats(-2, 2).filter(lambda gain: abs(gain) > 0.1)


def mimic(joint: str, gain: float = 1.0, shift: float = 0.0) -> str:
    return f'<mimic joint="{joint}" multiplier="{gain!r}" offset="{shift!r}"/>'


@given(GAIN, GAIN, st.floats(-1, 1), st.floats(-1, 1), st.floats(-1, 1))
def test_a_joint_follows_another_also_by_way_of_a_third(load, first, second, one, other, angle):
    arm = load(
        urdf(
            ("a", "revolute", "0 0 1", "0 0 0.3"),
            ("b", "revolute", "0 1 0", "0.2 0 0", mimic("a", first, one)),
            ("c", "prismatic", "1 0 0", "0.3 0 0", mimic("b", second, other)),
            ("d", "revolute", "1 0 0", "0.1 0 0"),
        )
    )
    coupling = arm.coupling
    assert coupling.columns == ("a", "d") and not coupling.slides.any()
    b = first * angle + one
    joints = coupling.joints(np.array([[angle, 0.7]]))
    assert joints == pytest.approx(np.array([[angle, b, second * b + other, 0.7]]))
    assert coupling.reported(joints) == pytest.approx(np.array([[angle, 0.7]]))
    lower, upper = coupling.limits
    for end, out in ((lower, np.array([-1e-6, 0])), (upper, np.array([1e-6, 0]))):
        inside, outside = coupling.joints(np.array([end - out, end + out]))
        assert (np.abs(inside) <= 2 + 1e-9).all() and (np.abs(outside) > 2).any()


def test_a_joint_outside_the_chain_may_drive_it():
    """As the virtual joint of a telescope of several sections."""
    section = '<parent link="base"/><child link="motor"/><axis xyz="0 0 1"/>'
    motor = f'<link name="motor"/><joint name="lift" type="prismatic">{section}'
    motor += '<limit lower="1" upper="3" effort="1" velocity="1"/></joint></robot>'
    sections = (
        ("middle", "prismatic", "0 0 1", "0 0 0", mimic("lift", 0.5, -0.5)),
        ("top", "prismatic", "0 0 1", "0 0 0", mimic("lift", 0.5, -0.5)),
        ("turn", "revolute", "0 0 1", "0 0 1"),
        ("end", "fixed", "0 0 1", "0.5 0 0"),
    )
    text = urdf(*sections).replace("</robot>", motor)

    arm = arm_of(text.encode(), Path("lift.urdf"), "link_4")
    assert arm.coupling.columns == ("lift", "turn")
    assert arm.coupling.slides.tolist() == [True, False]
    assert arm.coupling.limits.tolist() == [[1, -2], [3, 2]]
    height = arm.forward(arm.coupling.joints(np.array([[1.8, 0.3]])))[0, 2, 3]
    assert height == pytest.approx(1.8 - 1 + 1)


@pytest.mark.parametrize(
    ("joint", "message"),
    [
        ("b", "b follows 'b'"),
        ("c", "[bc] follows '[bc]'"),
        ("nowhere", "b follows 'nowhere'"),
        ("end", "b follows 'end'"),
    ],
)
def test_a_joint_that_follows_none_that_moves_is_refused(joint, message, load):
    text = urdf(
        ("a", "revolute", "0 0 1", "0 0 0.3"),
        ("b", "revolute", "0 1 0", "0.2 0 0", mimic(joint)),
        ("c", "revolute", "0 1 0", "0.2 0 0", mimic("b")),
        ("end", "fixed", "0 1 0", "0.2 0 0"),
    )
    with pytest.raises(UnsuitableRobot, match=message):
        load(text)
