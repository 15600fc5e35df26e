"""URDFs with mistakes: refused in a sentence, or used and corrected as they are read."""

import copy
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from recalib import RecalibError, UnsuitableRobot
from recalib.laboratory.urdf.origins import corrected_urdf
from recalib.nominal import arm_of
from tests.arms import RAILED, urdf
from tests.laboratory.test_urdf import random_calibration

PATH = Path("arm.urdf")
ARM = urdf(("one", "revolute", "0 0 1", "0 0 0.3"), ("two", "revolute", "0 1 0", "0.4 0 0"))
GRIPPER = (
    '<link name="hand"/><joint name="grip" type="revolute"><parent link="link_1"/>'
    '<child link="hand"/><limit lower="0" upper="1" effort="1" velocity="1"/></joint></robot>'
)
BACK = '<parent link="base"/><child link="link_2"/></joint></robot>'
LOOP = f'<joint name="back" type="revolute">{BACK}'
CIRCLE = """<link name="one"/><link name="two"/>
<joint name="j" type="fixed"><parent link="one"/><child link="two"/></joint>
<joint name="k" type="fixed"><parent link="two"/><child link="one"/></joint></robot>"""


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("</robot>", LOOP), "link_2 is the child of two joints, two and back, .* expected: a tre"),
        (('mass value="0.0"', 'mass value="nan"'), "the mass of link_1 in arm.urdf has value 'nan"),
        (('mass value="0.0"', 'mass value="-1"'), "one carries has no mass of an arm's link"),
        (('mass value="0.0"', 'mass value="1e7"'), "one carries has no mass of an arm's link"),
        (
            ('<mass value="0.0"/>', '<origin xyz="0 60 0"/><mass value="1"/>'),
            "one carries has its centre 50 m or more away in arm.urdf; are its lengths in m",
        ),
        (('xyz="0.4 0 0"', 'xyz="60 0 0"'), "two is 50 m or more .*; are its lengths in m"),
        (('rpy="0 0 0"', 'rpy="0 -90 0"'), "has rpy '0 -90 0'; expected: rad, not degrees"),
        (("</robot>", GRIPPER), "tool is missing; .*; at its ends are hand, link_2"),
        (('xyz="0 0 1"', 'xyz="0 0 1e-200"'), "the axis of one has no length"),
        ((' xyz="0 0 1"', ""), "the axis of one has no length"),
        (('xyz="0 0 1"', 'xyz=""'), "the axis of one in arm.urdf has xyz ''"),
        (('xyz="0.4 0 0"', 'xyz="0.4 0 inf"'), "the origin of two in arm.urdf has xyz '0.4 0 inf'"),
        (('upper="2"', 'upper="two"'), "the limit of one in arm.urdf has upper 'two'"),
        (('xyz="0.4 0 0"', 'xyz="0.4 0"'), "the origin of two has xyz '0.4 0'; expected: three nu"),
        (('name="one"', 'name="o&#10;ne"'), r"a joint in arm.urdf has the name 'o\\nne'"),
        (('name="two"', 'name=" "'), "a joint in arm.urdf has the name ' '"),
        (('name="link_2"', 'name="a&#x202e;"'), r"a link in arm.urdf has the name 'a\\u202e'"),
        (('"revolute"', '"planar"'), "joint one between .* is planar; expected"),
        (('"revolute"', '"floating"'), "joint one between .* is floating; expected"),
        (('lower="-2"', 'lower="3"'), "the limits of one are 3.0 to 2.0 in .* the lower one first"),
        (('link name="link_2"', 'link name="link_1"'), "has two links link_1; expected: a name"),
        (('joint name="two"', 'joint name="one"'), "has two joints one; expected: a name for each"),
        ((ARM, '<robot name="x"><link/><joint type="fixed"/></robot>'), "not a URDF"),
        (("</robot>", "<robot>"), r"it is not XML: line \d+, column \d+: no element found"),
    ],
)
def test_a_mistake_is_named(change, message):
    with pytest.raises(RecalibError, match=message):
        arm_of(ARM.replace(*change, 1).encode(), PATH)


def test_links_in_a_circle_are_no_part_of_the_arm_of_another_tool():
    source = ARM.replace("</robot>", CIRCLE).encode()
    for tool in (None, "one"):
        with pytest.raises(UnsuitableRobot, match="one and two of arm.urdf hang in a circle, on"):
            arm_of(source, PATH, tool)
    assert arm_of(source, PATH, arm_of(ARM.encode(), PATH).tool).tool


def test_an_arm_of_too_many_joints_is_refused():
    joints = (f"j{number}" for number in range(101))
    text = urdf(*((name, "revolute", "0 0 1", "0 0 0.1") for name in joints))
    with pytest.raises(UnsuitableRobot, match="101 joints of arm.urdf .* expected: at most 100"):
        arm_of(text.encode(), PATH)


WORDS = "nan inf -1 1e308 1e-308 a 1,2,3 ${x} 1e400 ١ base link_1 lift fixed continuous floating"
TEXTS = *WORDS.split(), "", "0 0 0", "1 2", " 1 0 0 ", "nan nan nan"
TAGS = "mimic", "origin", "axis", "limit", "parent", "child", "joint", "link", "inertial", "visual"
KEYS = "joint", "link", "name", "xyz", "value", "multiplier"


@st.composite
def spoilt(draw) -> bytes:
    """A URDF with elements taken out, doubled, renamed, added, or with other attributes."""
    root = ElementTree.fromstring(RAILED)
    for _ in range(draw(st.integers(1, 3))):
        elements = [*root.iter()]
        parents = {child: parent for parent in elements for child in parent}
        element = draw(st.sampled_from(elements))
        parent, text = parents.get(element), draw(st.sampled_from(TEXTS))
        match draw(st.sampled_from(["out", "twice", "other", "without", "more", "renamed"])):
            case "out" if parent is not None:
                parent.remove(element)
            case "twice" if parent is not None:
                place = draw(st.integers(0, len(parent)))
                parent.insert(place, copy.deepcopy(element))
            case "other" if element.attrib:
                element.set(draw(st.sampled_from([*element.attrib])), text)
            case "without" if element.attrib:
                element.attrib.pop(draw(st.sampled_from([*element.attrib])))
            case "more":
                key = draw(st.sampled_from(KEYS))
                ElementTree.SubElement(element, draw(st.sampled_from(TAGS)), {key: text})
            case "renamed":
                element.tag = draw(st.sampled_from(TAGS))
    return ElementTree.tostring(root)


@settings(max_examples=300)
@given(spoilt())
def test_a_spoilt_urdf_is_refused_or_corrected_as_it_is_read(source):
    try:
        arm = arm_of(source, PATH)
    except RecalibError:
        return
    joints = np.random.default_rng(0).uniform(-1, 1, (2, len(arm.joints)))
    calibration = random_calibration(arm)
    corrected, tool = corrected_urdf(source, calibration)
    again = arm_of(corrected, PATH, tool, arm.base).forward(joints)
    assert np.abs(again - calibration.forward(joints)).max() < 1e-8
