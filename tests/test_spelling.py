"""What may have been meant: a suggestion that is far off says less than none."""

import pytest

from recalib.spelling import instead, nearest

URDFS = ["a1.urdf", "finger_edu.urdf", "panda.urdf", "ur10_robot.urdf", "ur5_robot.urdf", "z1.urdf"]


@pytest.mark.parametrize(
    ("word", "meant"),
    [
        ("urr5_robot.urdf", "ur5_robot.urdf"),
        ("ur5_robto.urdf", "ur5_robot.urdf"),
        ("pandra.urdf", "panda.urdf"),
        ("PANDA.URDF", "panda.urdf"),
        ("nowhere.urdf", None),
        ("iiwa14.urdf", None),  # whose ending alone is that of all
        ("", None),
        ("x" * 5000, None),
    ],
)
def test_a_near_name_is_suggested(word, meant):
    assert nearest(word, URDFS) == meant


def test_few_names_are_listed_and_of_many_some():
    assert instead("on", ["off", "no"]) == "expected: off or no"
    assert instead("offf", ["off", "no"]) == "expected: off or no; did you mean off?"
    assert instead("x", []) == "expected: none"
    many = [f"joint_{number}" for number in range(68)]
    assert instead("jiont_67", many) == "did you mean joint_67?"
    assert instead("elbow", many) == "expected: one of 68, such as joint_0, joint_1 and joint_2"
