"""One arm in every layout that XML allows: the same placements, and every other byte stays."""

from pathlib import Path

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from recalib.laboratory.urdf.origins import angles_of, with_origins, written
from recalib.nominal.arms import arm_of

ORIGINS = {"one": ("0 0 0.3", "0.1 -0.2 0.3"), "two": ("0.05 0 0.4", "0 0 1.5"), "end": None}
NEW = {name: np.eye(4) for name in ORIGINS}
for number, pose in enumerate(NEW.values()):
    pose[:3, 3] = 0.1 * number, -0.2, 0.3 + number
    pose[:2, :2] = [[0, -1], [1, 0]]
SPACE = st.sampled_from(["", " ", "\n  ", "\r\n", "\t"])
BETWEEN = st.sampled_from(
    [
        *("", "\n", "\r\n\t", "<!-- <origin xyz='9 9 9'/> </joint> -->", "<?tool <origin/>?>"),
        "<![CDATA[<joint name='one'><origin/>]]>",
    ]
)
NAMESPACE = "http://example.org/robot"


@st.composite
def tag(draw, prefix: str, name: str, attributes: dict[str, str], empty: bool = True) -> str:
    """A start tag, or an empty element in either form."""
    text = f"<{prefix}{name}"
    for key in draw(st.permutations([*attributes])):
        quote = draw(st.sampled_from("'\""))
        value = attributes[key]
        if draw(st.booleans()):  # a reference to a character in place of it
            value = f"&#{ord(value[0])};{value[1:]}"
        gap = draw(SPACE) or " "
        text += f"{gap}{key}{draw(SPACE)}={draw(SPACE)}{quote}{value}{quote}"
    text += draw(SPACE)
    if not empty:
        return f"{text}>"
    return text + draw(
        st.sampled_from(["/>", f"></{prefix}{name}>", f"></{prefix}{name}{draw(SPACE)}>"])
    )


@st.composite
def layouts(draw) -> tuple[bytes, bytes, set[str]]:
    """A URDF, what it should be with new origins for some joints, and these joints."""
    prefix = draw(st.sampled_from(["", "", "u:"]))
    spaces = {"": {}, "default": {"xmlns": NAMESPACE}, "u": {"xmlns:u": NAMESPACE}}
    space = spaces["u"] if prefix else spaces[draw(st.sampled_from(["", "default"]))]
    encoding = draw(st.sampled_from(["utf-8", "utf-8", "iso-8859-1", "utf-16", "utf-8-sig"]))
    changed = draw(st.sets(st.sampled_from([*ORIGINS]), min_size=1))
    before, after = [], []

    def put(text: str, new: str | None = None) -> None:
        before.append(text)
        after.append(text if new is None else new)

    declared = {"utf-8-sig": "utf-8"}.get(encoding, encoding)
    outside = BETWEEN.filter(lambda text: "CDATA" not in text)
    if encoding != "utf-8" or draw(st.booleans()):
        put(f'<?xml version="1.0" encoding="{declared}"?>{draw(outside)}')
    entity = draw(st.booleans())
    if entity:
        put('<!DOCTYPE robot [<!ENTITY high "0.3"><!ENTITY more "<origin/>">]>')
    put(draw(tag(prefix, "robot", {"name": "a>b"} | space, empty=False)))
    links = ["base", "link", "hand", "tool"]
    for name in links:
        put(draw(BETWEEN) + draw(tag(prefix, "link", {"name": name})))
    put(f"{draw(BETWEEN)}<{prefix}transmission><{prefix}joint name='one'><{prefix}origin/>")
    put(f"</{prefix}joint></{prefix}transmission>")
    for index, (name, origin) in enumerate(ORIGINS.items()):
        kind = "fixed" if name == "end" else "revolute"
        put(draw(BETWEEN) + draw(tag(prefix, "joint", {"name": name, "type": kind}, empty=False)))
        parts = {
            "parent": {"link": links[index]},
            "child": {"link": links[index + 1]},
            "axis": {"xyz": "0 1 0"},
            "limit": {"lower": "-2", "upper": "2", "effort": "1", "velocity": "1"},
        }
        if origin:
            parts["origin"] = {"xyz": origin[0], "rpy": origin[1]}
        pose = NEW[name]
        new = f'<{prefix}origin xyz="{written(pose[:3, 3])}" rpy="{written(angles_of(pose))}"/>'
        if not origin and name in changed:
            put("", f"\n    {new}")
        for part in draw(st.permutations([*parts])):
            put(draw(BETWEEN))
            text = draw(tag(prefix, part, parts[part]))
            text = text.replace("0.3", "&high;") if entity else text
            put(text, new if part == "origin" and name in changed else None)
        if origin and draw(st.booleans()):  # one too many, which no reader looks at
            put(f"<{prefix}origin xyz='9 9 9'></{prefix}origin>")
        put(f"{draw(BETWEEN)}</{prefix}joint{draw(SPACE)}>")
    put(f"</{prefix}robot>")
    put(draw(outside))
    source, expected = ("".join(parts).encode(encoding) for parts in (before, after))
    return source, expected, changed


@settings(max_examples=150)
@given(layouts())
def test_a_layout_changes_no_placement_and_keeps_every_other_byte(layout):
    source, expected, changed = layout
    arm = arm_of(source, Path("arm.urdf"), "tool")
    joints = np.random.default_rng(0).uniform(-1, 1, (3, 2))
    plain = arm_of(PLAIN, Path("arm.urdf"), "tool")
    assert np.array_equal(arm.forward(joints), plain.forward(joints))
    corrected = with_origins(source, {name: NEW[name] for name in changed})
    assert corrected == expected
    again = arm_of(corrected, Path("arm.urdf"), "tool").forward(joints)
    other = arm_of(with_origins(PLAIN, {name: NEW[name] for name in changed}), Path("a"), "tool")
    assert np.array_equal(again, other.forward(joints))


PLAIN = b"""<robot name="a>b">
<link name="base"/><link name="link"/><link name="hand"/><link name="tool"/>
<joint name="one" type="revolute"><origin xyz="0 0 0.3" rpy="0.1 -0.2 0.3"/><parent link="base"/>
<child link="link"/><axis xyz="0 1 0"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
<joint name="two" type="revolute"><origin xyz="0.05 0 0.4" rpy="0 0 1.5"/><parent link="link"/>
<child link="hand"/><axis xyz="0 1 0"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
<joint name="end" type="fixed"><parent link="hand"/><child link="tool"/></joint></robot>"""
