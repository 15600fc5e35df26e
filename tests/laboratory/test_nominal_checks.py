import re
from functools import partial

import numpy as np
import pinocchio as pin
import pytest
from scipy.spatial.transform import Rotation

from recalib import Description, Observations, initial_frames, load_arm
from recalib.identification import NoInitialEstimate
from recalib.laboratory.plausibility.knowledge import checked_frames, mistake_in
from recalib.laboratory.plausibility.mistakes import (
    Mistaken,
    check_nominal,
    likely_mistake,
    mistake_of_outliers,
)
from tests.identification.real import Real, geometry_of
from tests.laboratory.conftest import ARM, ROWS, postures

TOOL_POINT = pin.SE3(np.eye(3), np.array([0.0, 0.02, 0.12])).homogeneous  # m


@pytest.fixture(scope="module")
def joints():
    middle = np.radians([20, -65, 100, -40, 95, 10])
    return middle + np.random.default_rng(3).uniform(-0.7, 0.7, (40, 6))


@pytest.fixture(scope="module")
def nominal(ur10, joints):
    """Where a tool point of the nominal arm is, in its base."""
    return (ur10.forward(joints) @ TOOL_POINT)[:, :3, 3]


def turned(degrees: float) -> np.ndarray:
    return pin.SE3(pin.exp3(np.radians([0, 0, degrees])), np.zeros(3)).homogeneous


def test_positions_of_the_nominal_arm_pass_and_frames_that_nobody_knows_are_told(
    ur10, joints, nominal
):
    assert check_nominal(ur10, joints, nominal, np.eye(4), TOOL_POINT) is None
    assert check_nominal(ur10, joints, ur10.forward(joints)[:, :3, 3]) is None
    offset = check_nominal(ur10, joints, nominal @ turned(170)[:3, :3].T)
    point = "a tool point at (0, 20, 120) mm of the tool link"
    assert offset == f"the base turned by 170.0 deg about (0, 0, 1) and {point}"


def changed(joints: np.ndarray, column: int, value) -> np.ndarray:
    other = joints.copy()
    other[:, column] = value(other[:, column])
    return other


euler = Rotation.from_euler
MIRROR = np.ones((4, 4))
MIRROR[1, 3] = -1  # of positions
MISTAKES = {
    "a sign": (lambda q, p: (changed(q, 2, np.negative), p), "the sign of elbow_joint"),
    "a zero": (
        lambda q, p: (changed(q, 1, lambda column: column + np.pi / 2), p),
        "the zero of shoulder_lift_joint, off by 90 deg",
    ),
    "the order": (
        lambda q, p: (q[:, [0, 1, 2, 4, 3, 5]], p),
        "the columns of wrist_1_joint and wrist_2_joint exchanged",
    ),
    "degrees": (lambda q, p: (np.degrees(q), p), "joint columns in degrees labelled rad"),
    "radians": (lambda q, p: (np.radians(q), p), "joint columns in radians labelled deg"),
    "metres for millimetres": (lambda q, p: (q, p * 1e-3), "positions in metres labelled mm"),
    "centimetres for millimetres": (lambda q, p: (q, p * 0.1), "positions in centimetres labelled"),
    "inches": (lambda q, p: (q, p / 25.4), "positions in inches labelled mm"),
    "a hundredth": (lambda q, p: (q, p * 0.01), "positions in metres labelled cm"),
    "a hundredfold": (lambda q, p: (q, p * 100), "positions in centimetres labelled m"),
    "a left-handed frame": (lambda q, p: (q, p * [1, -1, 1]), "positions with a reversed axis"),
    "the row before": (lambda q, p: (q[:-1], p[1:]), "joints of the row before"),
    "the row after": (lambda q, p: (q[1:], p[:-1]), "joints of the row after"),
    "two at once": (
        lambda q, p: (changed(changed(q, 2, np.negative), 3, lambda c: c - np.pi / 2), p),
        "the sign of elbow_joint and the zero of wrist_1_joint, off by -90 deg",
    ),
    "the unit of one joint": (
        lambda q, p: (changed(q, 2, np.radians), p),
        "a column elbow_joint that holds radians labelled deg",
    ),
    "half of a joint": (
        lambda q, p: (changed(q, 1, lambda column: column / 2), p),
        "a column shoulder_lift_joint that holds half of its turn",
    ),
    "the unit of one axis": (
        lambda q, p: (q, p * [1, 1e-3, 1]),
        "a column y in metres labelled mm",
    ),
    "all signs": (lambda q, p: (-q, p), "the signs of all joints"),
    "base turned": (lambda q, p: (q, p @ turned(-90)[:3, :3].T), "the base turned by 90.0 deg"),
}


@pytest.mark.parametrize(("spoil", "mistake"), MISTAKES.values(), ids=MISTAKES)
def test_the_likely_mistake_is_named(spoil, mistake, ur10, joints, nominal):
    with pytest.raises(Mistaken) as refusal:
        check_nominal(ur10, *spoil(joints, nominal), np.eye(4), TOOL_POINT)
    assert f"likely: {mistake}" in str(refusal.value)


@pytest.mark.parametrize("name", [*[*MISTAKES][:6], "a left-handed frame"])
def test_so_it_is_where_positions_are_measured_from_somewhere(name, ur10):
    spoil, mistake = MISTAKES[name]
    real = Real(ur10, 2)
    joints = real.postures(40)
    observations = Observations(*spoil(joints, real.poses(joints)[:, :3, 3]))
    with pytest.raises(NoInitialEstimate, match=f"; likely: {mistake}"):
        checked_frames(ur10, observations, Description())


@pytest.mark.parametrize(("factor", "unit"), [(180 / np.pi, "degrees"), (np.pi / 180, "radians")])
def test_where_a_joint_slides_the_unit_of_the_others_is_named(factor, unit):
    arm = load_arm("tiago.urdf", "hand_tool_link")
    real = Real(arm, 2)
    joints = real.postures(40)
    poses = real.poses(joints)
    joints[:, ~arm.slides] *= factor
    assert mistake_in(arm, Observations(joints, poses)).startswith(f"joint columns in {unit}")


def test_the_rounding_of_a_perfect_arm_is_no_mistake(ur10):
    """Joints moved one after the other: closed forms leave more or fewer digits of it."""
    for seed in range(12):
        joints = np.tile(np.radians([20, -65, 100, -40, 95, 10]), (36, 1))
        joints[range(36), np.arange(36) // 6] += np.random.default_rng(seed).uniform(-0.7, 0.7, 36)
        assert mistake_in(ur10, Observations(joints, ur10.forward(joints))) is None


@pytest.mark.parametrize("seed", [78, 121])
def test_what_closed_forms_alone_do_not_explain_is_no_mistake(seed):
    """Where only the wrist moved, they are off by more than with some wrong zero."""
    arm = load_arm("panda.urdf", "panda_link8")
    real = Real(arm, seed)
    joints = np.tile(Real(arm, seed).postures(1), (30, 1))
    joints[:, -3:] += np.random.default_rng(seed).uniform(-0.8, 0.8, (30, 3))
    observations = Observations(joints, real.poses(joints)[:, :3, 3])
    assert mistake_in(arm, observations, initial_frames(arm, observations)) is None


def reread(poses: np.ndarray, change) -> np.ndarray:
    """Poses (n, 4, 4) whose rotations were taken for others."""
    changed = poses.copy()
    changed[:, :3, :3] = change(Rotation.from_matrix(poses[:, :3, :3])).as_matrix()
    return changed


def test_a_pitch_of_a_right_angle_is_no_reason_for_a_warning(ur10, joints):
    right = lambda r: euler("xyz", [[0.2, np.pi / 2, 0.0]] * len(r))  # noqa: E731
    poses = reread(ur10.forward(joints), right)
    assert likely_mistake(ur10, joints, poses, most_steps=1) is None


FLIP = np.diag([1.0, -1.0, 1.0, 1.0])
LABELS = load_arm("ur10_robot.urdf", "tool0").joints


def mirrored(axis, turns):
    mirror = np.diag(1 - 2.0 * (np.arange(3) == axis))
    return Rotation.from_matrix(mirror @ turns.as_matrix() @ mirror)


REREAD = {  # by the mistake, a change of rotations r
    "rotations of another frame or in another notation": lambda r: r[::-1],
    "rotations of the instrument in the target's frame": lambda r: r.inv(),
    "a quaternion in the order qw, qx, qy, qz": lambda r: Rotation.from_quat(
        r.as_quat()[:, [3, 0, 1, 2]]
    ),
    "roll, pitch and yaw about moving axes": lambda r: euler("xyz", r.as_euler("XYZ")),
    "roll, pitch and yaw in radians labelled deg": lambda r: euler(
        "xyz", np.radians(r.as_euler("xyz"))
    ),
    "a rotation vector in radians labelled deg": lambda r: Rotation.from_rotvec(
        np.radians(r.as_rotvec())
    ),
    "roll, pitch and yaw in reverse order": lambda r: euler("xyz", r.as_euler("xyz")[:, ::-1]),
    **{
        f"rotations of a left-handed frame, or of one half turned about {name}": partial(
            mirrored, axis
        )
        for axis, name in enumerate("xyz")
    },
}
POSES = {  # by the mistake, a change of joints and poses
    "poses of the instrument in the target's frame": lambda q, p: (q, np.linalg.inv(p)),
    "positions with a reversed axis": lambda q, p: (q, p * MIRROR),
    "positions with a reversed axis, or two exch": lambda q, p: (q, FLIP @ p @ FLIP),
    **{
        f"columns {LABELS[first]} to {LABELS[last]} that hold radians labelled deg": (
            lambda q, p, some=slice(first, last + 1): (
                np.hstack([q[:, : some.start], np.radians(q[:, some]), q[:, some.stop :]]),
                p,
            )
        )
        for first, last in ((3, 5), (0, 2), (1, 4))
    },
    **{
        mistake: lambda q, p, change=change: (q, reread(p, change))
        for mistake, change in REREAD.items()
    },
    # with these joints, positions alone are explained: as if the rotations were wrong
    "the columns of wrist_1_joint and wrist_2_joint exchanged": lambda q, p: (
        q[:, [0, 1, 2, 4, 3, 5]],
        p,
    ),
    "the sign of wrist_3_joint": lambda q, p: (changed(q, 5, np.negative), p),
    "the sign of shoulder_pan_joint or the zero of shoulder_lift_joint, off by 180 deg": (
        lambda q, p: (changed(q, 0, np.negative), p)
    ),
}


@pytest.mark.parametrize(("mistake", "spoil"), POSES.items(), ids=POSES)
def test_so_it_is_of_poses(mistake, spoil, arm, ur10):
    """Pairs of mistakes are few where three joints turn."""
    real = Real(arm := ur10 if re.search("column|sign", mistake) else arm, 2)
    joints = real.postures(40)
    with pytest.raises(NoInitialEstimate, match=f"; likely: {mistake}"):
        checked_frames(arm, Observations(*spoil(joints, real.poses(joints))), Description())


def test_a_tool_that_was_forgotten_is_named(ur10, joints, nominal):
    with pytest.raises(Mistaken, match="likely: a tool point at"):
        check_nominal(ur10, joints, nominal, np.eye(4), np.eye(4))


def test_another_arm_and_positions_that_are_all_one_are_no_mistake_of_a_column(arm, load):
    other, joints = load(ARM.replace("0.4 0 0", "0.3 0.1 0")), postures(3)
    for positions in (other.forward(joints)[:, :3, 3], np.ones((ROWS, 3))):
        with pytest.raises(Mistaken, match="is it another arm"):
            check_nominal(arm, joints, positions)


def test_a_mistake_leaves_no_row_far_off(arm):
    """As a row that was measured elsewhere."""
    joints = postures(3)
    wrong, observed = changed(joints, 1, np.negative), arm.forward(joints)[:, :3, 3]
    assert likely_mistake(arm, wrong, observed) == "the sign of lift"
    observed[len(observed) // 2] += 0.02
    assert likely_mistake(arm, wrong, observed) is None


@pytest.mark.parametrize("count", [3, 8])
@pytest.mark.parametrize(
    "name", ["radians", "the unit of one joint", "metres for millimetres", "a sign"]
)
def test_a_mistake_in_some_rows_is_named(name, count, ur10):
    real, (spoil, words) = Real(ur10, 2), MISTAKES[name]
    joints = real.postures(40)
    places = real.poses(joints)[:, :3, 3]
    geometry = geometry_of(ur10, Observations(joints, places))
    assert mistake_of_outliers(geometry, Observations(joints, places)) is None
    joints[-count:], places[-count:] = spoil(joints[-count:], places[-count:])
    rows = Observations(joints, places)
    told = mistake_of_outliers(geometry_of(ur10, rows), rows)
    assert told and re.match(f"{count} rows, from {41 - count} to 40, .*: {words}", told)
