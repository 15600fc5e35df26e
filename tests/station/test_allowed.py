"""Where an arm may be sent: limits, span, box, floor and itself; and what it asks before a move."""

import io
import os
import sys
import threading
import time

import numpy as np
import pinocchio as pin
import pytest

from recalib import Answer, InvalidSetting, StationFailed, load_arm, load_shapes
from recalib.laboratory.live.allowed import AllowedPostures, Box
from recalib.laboratory.live.clearance import FLOOR, MARGIN, TOOL, Clearance
from recalib.laboratory.live.command import ask_to_move
from recalib.laboratory.live.session import Move
from recalib.station.guarded import REACHED
from tests.arms import SCARA
from tests.station.conftest import MOST
from tests.station.simulated import HOMES, URDFS, Simulated

AROUND = Box(np.array([-2.0, -2.0, 0.1]), np.array([2.0, 2.0, 2.0]))
SPAN, WIDE = np.radians([45, 75])


def allowed(name, floor=0.0, touching=False, radius=0.0, span=SPAN):
    """The arm, its shapes, and the postures that keep off the floor and, maybe, off themselves."""
    arm, home = load_arm(*URDFS[name]), np.array(HOMES[name], dtype=float)
    shapes, missing = load_shapes(arm, URDFS[name][0])
    assert not missing
    limits = arm.model.lowerPositionLimit, arm.model.upperPositionLimit
    clearance = Clearance(arm, home, shapes, floor, not touching, radius)
    return arm, shapes, AllowedPostures(arm, home, limits, span, None, clearance)


def lowest(arm, shapes, joints) -> float:
    """The height [m] of the lowest vertex beyond the second link, and of the tool."""
    data, placed = arm.model.createData(), shapes.createData()
    pin.updateGeometryPlacements(arm.model, data, shapes, placed, joints)
    heights = [arm.forward(joints[None])[0, 2, 3]]
    for shape, place in zip(shapes.geometryObjects, placed.oMg, strict=True):
        if shape.parentJoint > 2 and hasattr(shape.geometry, "vertices"):
            vertices = shape.geometry.vertices()
            heights.append((vertices @ place.rotation.T + place.translation)[:, 2].min())
    return min(heights)


@pytest.mark.parametrize("name", ["UR5", "Panda"])
def test_links_and_tool_stay_above_the_floor_also_on_the_way(name):
    arm, shapes, postures = allowed(name)
    ways = [postures.home + part * (goal - postures.home) for goal in postures.joints[:20]
            for part in (0.5, 1.0)]  # fmt: skip
    assert min(lowest(arm, shapes, joints) for joints in ways) > MARGIN - 1e-3
    *_, anywhere = allowed(name, floor=None)
    assert min(lowest(arm, shapes, joints) for joints in anywhere.joints[:100]) < 0


def test_all_links_beyond_the_second_and_the_tool_keep_off_the_floor():
    arm, shapes, postures = allowed("UR5")
    pairs = Clearance(arm, postures.home, shapes, 0.0, False, 0.0).pairs
    beyond = {shape.name for shape in shapes.geometryObjects if shape.parentJoint > 2}
    assert {link for link, other in pairs if other == FLOOR} == beyond | {TOOL}


def test_an_arm_does_not_pass_a_narrow_obstacle_between_two_checks():
    """One joint turns by 29 deg; the middle 3 deg of the way are outside the box."""
    station = Simulated()
    x, y, _ = station.arm.forward(station.stands[None])[0, :3, 3]
    forward = station.stands - np.arctan2(y, x) * np.eye(6)[0]
    start, goal = (forward + turn * np.eye(6)[0] for turn in (-0.25, 0.25))
    farthest = np.hypot(x, y) * np.cos(0.03) - REACHED  # with which the station may miss a posture
    box = Box(np.full(3, -2.0), np.array([farthest, 2.0, 2.0]))
    postures = AllowedPostures(station.arm, start, station.limits, SPAN, box)
    with pytest.raises(StationFailed, match="the arm would pass with its tool at .* --box"):
        postures.check(start, goal)


def test_a_board_on_the_tool_stays_above_the_floor_however_it_is_turned():
    arm, _, postures = allowed("UR10", radius=0.15)
    assert arm.forward(postures.joints)[:, 2, 3].min() > 0.15


def test_links_keep_apart_from_each_other(monkeypatch):
    """Their meshes, of which the hulls are checked; neighbours touch in all postures."""
    arm, shapes, postures = allowed("Panda", floor=None, span=WIDE)
    numbered = [*enumerate(shape.parentJoint for shape in shapes.geometryObjects)]
    for one, low in numbered:
        for other, high in numbered:
            if low + 4 < high:
                shapes.addCollisionPair(pin.CollisionPair(one, other))
    data, placed = arm.model.createData(), shapes.createData()
    for request in placed.collisionRequests:
        request.security_margin = MARGIN - 1e-3

    def touches(joints) -> bool:
        return pin.computeCollisions(arm.model, data, shapes, placed, joints, True)

    assert not any(map(touches, postures.joints))
    monkeypatch.setattr(MOST, 400)  # few of them touch
    *_, anywhere = allowed("Panda", floor=None, touching=True, span=WIDE)
    assert any(map(touches, anywhere.joints))


def test_links_that_are_near_in_the_first_posture_may_be_so():
    arm, shapes, _ = allowed("UR10", floor=None)
    clearance = Clearance(arm, np.array(HOMES["UR10"]), shapes, None, True, 0.0)
    drawn = np.random.default_rng(0).uniform(-np.pi, np.pi, (1000, 6))
    near = [joints for joints in drawn if clearance.touching(joints)][:5]
    assert len(near) == 5
    for home in near:
        assert Clearance(arm, home, shapes, None, True, 0.0).touching(home) is None


def test_shapes_that_no_file_has_are_named(tmp_path):
    source = """<robot name="arm"><link name="base"/><link name="tip"><collision><geometry>
        <mesh filename="gone.stl"/></geometry></collision><collision><geometry>
        <box size="1 1 1"/></geometry></collision></link><joint name="j" type="revolute">
        <parent link="base"/><child link="tip"/><axis xyz="0 0 1"/><origin xyz="0 0 1"/>
        <limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>"""
    (tmp_path / "arm.urdf").write_text(source)
    arm = load_arm(tmp_path / "arm.urdf")
    shapes, missing = load_shapes(arm, tmp_path / "arm.urdf")
    assert missing == ["gone.stl"] and shapes.ngeoms == 1
    (shape,) = shapes.geometryObjects
    assert (shape.name, shape.parentJoint) == ("tip", 1)
    pairs = Clearance(arm, np.zeros(1), shapes, 0.0, False, 0.0).pairs
    assert pairs == [(TOOL, FLOOR)], "the first links may be near the floor, the tool may not"


def test_postures_are_within_the_limits_of_both():
    station = Simulated()
    home, limits = station.stands, (np.full(6, -2.5), np.full(6, 2.0))
    postures = AllowedPostures(station.arm, home, limits, 0.5, AROUND).joints
    assert (np.abs(postures - home) <= 0.5).all()
    assert (postures >= -2.5).all() and (postures <= 2.0).all()
    low = Clearance(station.arm, home, pin.GeometryModel(), 0.3, True, 0.0)
    for changed, match in (
        ({"home": home + 0.2 * np.eye(6)[2]}, "'elbow_joint at 120.3 deg'; expected: -143.2 to 11"),
        ({"box": Box(np.zeros(3), np.full(3, 0.5))}, "the tool at .* expected: within --box"),
        ({"box": Box.read(["77 cm to 78 cm", "16 cm to 17 cm", "23 cm to 25 cm"])}, "allowed"),
        ({"clearance": low}, "nearer than 20 mm to the floor'; expected: .* --floor"),
    ):
        settings = {"home": home, "limits": limits, "span": 0.5, "box": AROUND} | changed
        with pytest.raises(InvalidSetting, match=match):
            AllowedPostures(station.arm, **settings)


@pytest.mark.parametrize("joint", range(6))
@pytest.mark.parametrize("by", [-2.5, 0.6])
def test_where_an_arm_was_left_outside_the_span_it_stays(joint, by):
    """Each joint, either way; but it may miss its goal by a little."""
    station = Simulated()
    postures = AllowedPostures(station.arm, station.stands, station.limits, 0.5)
    away = np.eye(6)[joint]
    found = f"its tool at .* mm and {station.arm.joints[joint]} at .*--span of the first.*by hand"
    with pytest.raises(StationFailed, match=found):
        postures.check(station.stands + by * away, postures.joints[0])
    postures.check(station.stands + np.sign(by) * 0.505 * away, postures.joints[0])


@pytest.mark.parametrize("above", [0.008, 0.012])
def test_half_of_the_margin_is_for_a_station_that_misses_a_posture(above):
    station = Simulated()
    home, goal = station.stands, station.stands + 0.2 * np.eye(6)[1]
    floor = station.arm.forward(goal[None])[0, 2, 3] - above
    clearance = Clearance(station.arm, home, pin.GeometryModel(), floor, True, 0.0)
    postures = AllowedPostures(station.arm, home, station.limits, SPAN, None, clearance)
    if above > MARGIN - REACHED:
        return postures.check(home, goal)
    with pytest.raises(StationFailed, match="would pass with its tool at .* to the floor"):
        postures.check(home, goal)


def test_an_arm_goes_by_way_of_home_if_something_is_in_the_straight_way():
    station = Simulated()
    box = Box(np.array([0.3, -0.6, 0.15]), np.array([1.2, 0.7, 0.35]))
    postures = AllowedPostures(station.arm, station.stands, station.limits, SPAN, box)
    pairs = zip(postures.joints, postures.joints[1:], strict=False)
    paths = [(start, postures.path(start, goal)) for start, goal in pairs]
    assert {len(path) for _, path in paths} == {1, 2}
    for start, path in paths:
        for goal in path:
            way = station.arm.forward(np.linspace(start, goal, 50))[:, :3, 3]
            assert (way >= box.low - 0.01).all() and (way <= box.high + 0.01).all()
            start = goal
        assert len(path) == 1 or np.array_equal(path[0], station.stands)


@pytest.mark.parametrize("by", [-0.15, 0.15])  # m
def test_a_joint_that_slides_moves_by_half_a_metre_for_each_rad(by, load, monkeypatch, capsys):
    arm, home, widths = load(SCARA), np.array([0.2, 1.0, 0.3, 0.5]), 0.2 * np.array([1, 1, 0.5, 1])
    postures = AllowedPostures(arm, home, (np.full(4, -3.0), np.full(4, 3.0)), 0.2)
    farthest = np.abs(postures.joints - home).max(axis=0)
    assert (0.9 * widths < farthest).all() and (farthest <= widths).all()
    away = home + by * np.eye(4)[2]
    x, y, z = 1e3 * arm.forward(away[None])[0, :3, 3]
    found = rf"at \({x:.0f}, {y:.0f}, {z:.0f}\) mm and quill at {300 + 1e3 * by:.1f} mm; expected: "
    with pytest.raises(StationFailed, match=rf"{found}200.0 to 400.0 mm, within --span"):
        postures.check(away, home)
    monkeypatch.setattr("sys.stdin", io.StringIO("\n"))
    ask_to_move(arm, Move(home, away, np.zeros(3), np.ones(3)))
    assert f": quill by {1e3 * by:+.1f} mm\n" in capsys.readouterr().err


@pytest.mark.parametrize("wrong", ["1 m", "a to b", "1 m to 0 m", "0 m to 0 m", "0 m to 1 deg"])
@pytest.mark.parametrize("axis", range(3))
def test_a_box_has_a_range_along_each_axis(wrong, axis):
    ranges = ["0 m to 1 m"] * 3
    ranges[axis] = wrong
    with pytest.raises(InvalidSetting, match="--box"):
        Box.read(ranges)


@pytest.mark.usefixtures("all_postures")
def test_the_same_postures_are_drawn_tomorrow():
    """A calibration that was killed goes on with them: other ones would be another session."""
    station = Simulated()
    postures = AllowedPostures(station.arm, station.stands, station.limits, 0.5, AROUND).joints
    first = [-0.15058, -1.18557, 2.16767, -2.33245, -1.39986, -0.16067]
    last = [0.10496, -1.50732, 1.5378, -1.80682, -1.33689, -0.26607]
    assert len(postures) == 400
    assert postures[[0, -1]] == pytest.approx(np.array([first, last]), abs=1e-5)


@pytest.fixture
def arm_and_move():
    """Joints 1 and 3 of a UR10 turn, its tool goes from one place to another."""
    station = Simulated()
    goal = station.stands + np.radians([30, 0, -12.34, 0, 0, 0])
    places = station.arm.forward(np.array([station.stands, goal]))[:, :3, 3]
    return station.arm, Move(station.stands, goal, *places)


def test_a_prompt_says_where_the_tool_goes_and_which_joints_turn(arm_and_move, monkeypatch, capsys):
    arm, move = arm_and_move
    for typed, answer in (("\n", Answer.MOVE), ("S\n", Answer.SKIP), ("q\n", Answer.END),
                          ("no\n", Answer.END)):  # fmt: skip
        monkeypatch.setattr("sys.stdin.readline", lambda typed=typed: typed, raising=False)
        assert ask_to_move(arm, move) is answer
    text = capsys.readouterr().err
    for place in (move.tool_before, move.tool_after):
        assert f"({', '.join(f'{1e3 * x:.0f}' for x in place)})" in text
    away = 1e3 * np.linalg.norm(move.tool_after - move.tool_before)
    assert f"{away:.0f} mm away: shoulder_pan_joint by +30.0 deg, elbow_joint by -12.3 deg" in text
    assert text.count("joint by") == 8 and "s: skip this posture for good, q: end" in text
    for closed in (None, io.StringIO()):
        monkeypatch.setattr("sys.stdin", closed)
        with pytest.raises(InvalidSetting, match="an answer is missing; expected: a person at"):
            ask_to_move(arm, move)


def test_what_was_typed_before_the_prompt_is_no_answer(arm_and_move, monkeypatch):
    person, terminal = os.openpty()
    with os.fdopen(terminal, "r") as typed:
        monkeypatch.setattr(sys, "stdin", typed)
        os.write(person, b"\n\n\n")

        def answer() -> None:
            time.sleep(0.1)
            os.write(person, b"s\n")

        threading.Thread(target=answer).start()
        assert ask_to_move(*arm_and_move) is Answer.SKIP
    os.close(person)
