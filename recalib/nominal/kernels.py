"""Compiled loops over poses and postures: coordinates, forward and inverse kinematics, moves.

Each function handles all runs in one call, and computes every pose independently: its result does
not depend on other poses in the call, to the last bit. All functions are in one file because
Numba's cache checks only the file of the called function for changes, not the files of others.

A pose is three rows of a homogeneous matrix. Every joint turns about, or slides along, the z axis
of its frame: `recalib.nominal.chain` rotates an arm's frames accordingly.
"""

from typing import Any, NamedTuple

import numpy as np

from recalib.numerics.compiled import compiled, inner

TOLERANCE = 1e-11  # of the residual, in m and rad: a hundredth of the controller's tolerance
STEPS = 25
SMALL = 1e-6  # m, rad: a rotation with a smaller sine is about 0 or 180 degrees
LONGEST_STEP = 0.5  # rad: keeps Newton's method on the branch on which it starts
SINGULAR = 1e9  # rad: a longer step comes from a singular Jacobian
TRUSTED = 1.5  # coordinates; up to here the start polynomial is used, as commands exceed 1 slightly


Plain = tuple[Any, ...]  # the fields of one of the classes below


class Arms(NamedTuple):
    """Serial arms of n joints, side by side; `recalib.nominal.chain` makes them.

    Attributes:
        placements: (arm, n + 1, 3, 4) poses [m] of each joint in the frame of the previous joint,
            and of the tool in the last joint's frame.
        slides: (arm, n) whether a joint slides along its z axis; otherwise it turns about it.
    """

    placements: np.ndarray
    slides: np.ndarray


class Region(NamedTuple):
    """A workspace, as `recalib.nominal.workspace.Workspace` describes it."""

    centre: np.ndarray
    half_ranges: np.ndarray
    vectors: bool


class ControllerArrays(NamedTuple):
    """A controller: the nominal arm, its workspace, and the start polynomial.

    Attributes:
        placements, slides: see `Arms`.
        centre, half_ranges, vectors: see `Region`.
        shorter, last: (F,) the monomials of the start polynomial; see `recalib.numerics.monomials`.
        weights: (F, n) coefficients of the monomials, for joint angles [rad].
        lower, upper: (n,) joint limits [rad].
    """

    placements: np.ndarray
    slides: np.ndarray
    centre: np.ndarray
    half_ranges: np.ndarray
    vectors: bool
    shorter: np.ndarray
    last: np.ndarray
    weights: np.ndarray
    lower: np.ndarray
    upper: np.ndarray


@compiled
def poses_at(coordinates: np.ndarray, region: Plain) -> np.ndarray:
    """Poses (n, 4, 4) [m] at coordinates (n, 6) of a workspace."""
    box, poses = Region(*region), np.zeros((len(coordinates), 4, 4))
    relative = np.empty((3, 3))
    for index in range(len(coordinates)):
        _write_pose(coordinates[index], box, relative, poses[index])
        poses[index, 3, 3] = 1
    return poses


@compiled
def coordinates_of(poses: np.ndarray, region: Plain) -> np.ndarray:
    """Workspace coordinates (n, 6) of poses (n, 4, 4) [m]."""
    box, coordinates, relative = Region(*region), np.empty((len(poses), 6)), np.empty((3, 3))
    for index in range(len(poses)):
        _write_coordinates(poses[index], box, relative, coordinates[index])
    return coordinates


@compiled
def distances(achieved: np.ndarray, desired: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Distances (n,) [m] and rotation angles (n,) [rad] between poses (n, 4, 4)."""
    lengths, angles = np.empty(len(achieved)), np.empty(len(achieved))
    for index in range(len(achieved)):
        one, other = achieved[index], desired[index]
        squares, sine, cosine = 0.0, 0.0, -1.0
        for row in range(3):
            squares += (one[row, 3] - other[row, 3]) ** 2
            following, last = (row + 1) % 3, (row + 2) % 3
            turn = 0.0
            for column in range(3):
                turn += one[last, column] * other[following, column]
                turn -= one[following, column] * other[last, column]
                cosine += one[row, column] * other[row, column]
            sine += turn**2
        lengths[index], angles[index] = np.sqrt(squares), np.arctan2(np.sqrt(sine), cosine)
    return lengths, angles


@compiled
def forward(chain: Plain, angles: np.ndarray) -> np.ndarray:
    """Poses (run, posture, 4, 4) of the tools [m] at joint angles (run, posture, n) [rad].

    There is one arm for each run, or one arm for all runs.
    """
    arms, (count, postures, joints) = Arms(*chain), angles.shape
    poses = np.zeros((count, postures, 4, 4))
    origins, axes = np.empty((joints, 3)), np.empty((joints, 3))
    for run in range(count):
        arm = run if len(arms.slides) > 1 else 0
        for posture in range(postures):
            pose = poses[run, posture]
            _stand(arms, arm, angles[run, posture], pose, origins, axes)
            pose[3, 3] = 1
    return poses


@compiled
def solve(chain: Plain, poses: np.ndarray, start: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Joint angles (posture, n) [rad] that take the first arm's tool to poses, and their errors."""
    arms = Arms(*chain)
    found, errors, scratch = start.copy(), np.empty(len(start)), _scratch(start.shape[1])
    for index in range(len(start)):
        errors[index] = _newton(arms, poses[index], found[index], scratch)
    return found, errors


@compiled
def targets(
    placements: np.ndarray,
    slides: np.ndarray,
    centre: np.ndarray,
    half_ranges: np.ndarray,
    vectors: bool,
    shorter: np.ndarray,
    last: np.ndarray,
    weights: np.ndarray,
    lower: np.ndarray,
    upper: np.ndarray,
    commands: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Joint angles (n, joint) [rad] that a controller chooses for commands (n, 6).

    Also returns the errors (n,) of their poses [m, rad], and whether they are within limits (n,).

    Args:
        placements, ..., upper: the fields of `ControllerArrays`, as separate arguments: Numba
            unpacks them three times as fast, which halves the time of a few moves.
        commands: workspace coordinates.
    """
    nominal = ControllerArrays(
        placements, slides, centre, half_ranges, vectors, shorter, last, weights, lower, upper
    )
    joints = weights.shape[1]
    angles, errors = np.empty((len(commands), joints)), np.empty(len(commands))
    within = np.empty(len(commands), dtype=np.bool_)
    scratch, room = _scratch(joints), _room(len(last))
    for index in range(len(commands)):
        answer = _answer(nominal, commands[index], room, scratch, angles[index])
        errors[index], within[index] = answer
    return angles, errors, within


@compiled
def move(
    placements: np.ndarray,
    slides: np.ndarray,
    centre: np.ndarray,
    half_ranges: np.ndarray,
    vectors: bool,
    shorter: np.ndarray,
    last: np.ndarray,
    weights: np.ndarray,
    lower: np.ndarray,
    upper: np.ndarray,
    damaged_placements: np.ndarray,
    damaged_slides: np.ndarray,
    homes: np.ndarray,
    commands: np.ndarray,
    refused: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """The poses of damaged arms at the joint angles that a controller chooses for commands.

    Args:
        placements, ..., upper: as in `targets`.
        damaged_placements, damaged_slides: fields of `Arms`, one arm for each run or for all runs.
        homes: (arm, 6) coordinates of each arm after a refused move.
        commands: (run, move, 6) coordinates.
        refused: (run,) number of refused commands so far; updated in place.

    Returns the achieved poses (run, move, 6) in coordinates, and whether each command was executed
    (run, move).
    """
    nominal = ControllerArrays(
        placements, slides, centre, half_ranges, vectors, shorter, last, weights, lower, upper
    )
    damaged, box = Arms(damaged_placements, damaged_slides), Region(centre, half_ranges, vectors)
    (runs, moves, _), joints = commands.shape, weights.shape[1]
    achieved, executed = np.empty(commands.shape), np.empty((runs, moves), dtype=np.bool_)
    scratch, room, angles = _scratch(joints), _room(len(last)), np.empty(joints)
    pose, relative, origins, axes = scratch[1], room[2], scratch[2], scratch[3]
    for run in range(runs):
        arm = run if len(homes) > 1 else 0
        for index in range(moves):
            error, within = _answer(nominal, commands[run, index], room, scratch, angles)
            executed[run, index] = error <= TOLERANCE and within
            if executed[run, index]:
                _stand(damaged, arm, angles, pose, origins, axes)
                _write_coordinates(pose, box, relative, achieved[run, index])
            else:
                _copy(homes[arm], achieved[run, index])
                refused[run] += 1
    return achieved, executed


@inner
def _room(monomials: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Work arrays of `_answer`: monomials, coordinates, a relative rotation and a pose."""
    return np.empty(monomials), np.empty(6), np.empty((3, 3)), np.empty((3, 4))


@inner
def _answer(
    nominal: ControllerArrays,
    command: np.ndarray,
    room: tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray],
    scratch: tuple[np.ndarray, ...],
    angles: np.ndarray,
) -> tuple[float, bool]:
    """Write the joint angles (n,) for a command; return their error, and if they are allowed."""
    arms = Arms(nominal.placements, nominal.slides)
    box = Region(nominal.centre, nominal.half_ranges, nominal.vectors)
    products, point, relative, pose = room
    _write_pose(command, box, relative, pose)
    _copy(command, point)
    far = False
    for number in range(3, 6):
        far |= abs(point[number] * box.half_ranges[number]) > np.pi / 2
    if far:  # a rotation beyond 90 degrees may equal one with smaller coordinates
        _write_coordinates(pose, box, relative, point)
    if _longest(point) > TRUSTED:
        # the polynomial is useless so far out: start from the nearest pose inside instead
        for number in range(6):
            point[number] = min(max(point[number], -1.0), 1.0)
    products[0] = 1
    for joint in range(len(angles)):
        angles[joint] = nominal.weights[0, joint]
    for index in range(1, len(products)):
        products[index] = products[nominal.shorter[index]] * point[nominal.last[index]]
        for joint in range(len(angles)):
            angles[joint] += products[index] * nominal.weights[index, joint]
    error, within = _newton(arms, pose, angles, scratch), True
    for joint in range(len(angles)):
        within &= nominal.lower[joint] <= angles[joint] <= nominal.upper[joint]
    return error, within


@inner
def _stand(
    arms: Arms,
    arm: int,
    angles: np.ndarray,
    pose: np.ndarray,
    origins: np.ndarray,
    axes: np.ndarray,
) -> None:
    """Write the tool's pose (3 or 4, 4), and the joints' origins and axes, both (n, 3)."""
    placements, slides, joints = arms.placements[arm], arms.slides[arm], len(angles)
    for row in range(3):
        for column in range(4):
            pose[row, column] = placements[0, row, column]
    for joint in range(joints):
        angle = angles[joint]
        sine, cosine, along = 0.0, 1.0, angle
        if not slides[joint]:
            sine, cosine, along = np.sin(angle), np.cos(angle), 0.0
        after = placements[joint + 1]
        for row in range(3):
            x, y, z, p = pose[row, 0], pose[row, 1], pose[row, 2], pose[row, 3]
            origins[joint, row], axes[joint, row] = p, z
            x, y, p = cosine * x + sine * y, cosine * y - sine * x, p + along * z
            for column in range(3):
                pose[row, column] = (
                    x * after[0, column] + y * after[1, column] + z * after[2, column]
                )
            pose[row, 3] = x * after[0, 3] + y * after[1, 3] + z * after[2, 3] + p


@inner
def _write_jacobian(
    arms: Arms, pose: np.ndarray, origins: np.ndarray, axes: np.ndarray, jacobian: np.ndarray
) -> None:
    """Write the tool's Jacobian (6, n), given the joints' origins and axes from `_stand`."""
    for joint in range(len(origins)):
        for row in range(3):
            if arms.slides[0, joint]:
                jacobian[row, joint], jacobian[3 + row, joint] = axes[joint, row], 0
                continue
            one, other = (row + 1) % 3, (row + 2) % 3
            jacobian[row, joint] = axes[joint, one] * (
                pose[other, 3] - origins[joint, other]
            ) - axes[joint, other] * (pose[one, 3] - origins[joint, one])
            jacobian[3 + row, joint] = axes[joint, row]


@inner
def _scratch(joints: int) -> tuple[np.ndarray, ...]:
    """Work arrays of `_newton`: angles, pose, origins, axes, Jacobian, residual and step."""
    return (
        np.empty(joints),
        np.empty((3, 4)),
        np.empty((joints, 3)),
        np.empty((joints, 3)),
        np.empty((6, joints)),
        np.empty(6),
        np.empty(joints),
    )


@inner
def _newton(
    arms: Arms, goal: np.ndarray, found: np.ndarray, scratch: tuple[np.ndarray, ...]
) -> float:
    """Improve joint angles (n,) in place until they take the tool to a goal; return their error.

    The error is the largest component of the residual, in m and rad. It is infinite if the goal or
    the initial angles contain nan.
    """
    angles, pose, origins, axes, jacobian, residual, step = scratch
    joints, error = len(found), np.inf
    _copy(found, angles)
    for _ in range(STEPS):
        _stand(arms, 0, angles, pose, origins, axes)
        largest = _residual(pose, goal, residual)
        if largest < error:
            _copy(angles, found)
            error = largest
        if error <= TOLERANCE or np.isnan(largest):
            break
        _write_jacobian(arms, pose, origins, axes, jacobian)
        if joints == 6:
            _copy(residual, step)
        if joints != 6 or not _eliminate(jacobian, step):
            _write_jacobian(arms, pose, origins, axes, jacobian)
            _copy(_shortest_step(jacobian, residual), step)
        shorter = LONGEST_STEP / max(LONGEST_STEP, _longest(step))
        for joint in range(joints):
            angles[joint] += shorter * step[joint]
    return error


@inner
def _copy(vector: np.ndarray, to: np.ndarray) -> None:
    for index in range(len(vector)):
        to[index] = vector[index]


@inner
def _shortest_step(jacobian: np.ndarray, residual: np.ndarray) -> np.ndarray:
    """The shortest of the steps (n,) that minimise the residual r; for n > 6, J' inv(J J') r."""
    if jacobian.shape[1] > 6:
        square, vector = np.zeros((6, 6)), residual.copy()
        for row in range(6):
            for column in range(6):
                for joint in range(jacobian.shape[1]):
                    square[row, column] += jacobian[row, joint] * jacobian[column, joint]
        if _eliminate(square, vector):
            step = np.zeros(jacobian.shape[1])
            for joint in range(len(step)):
                for row in range(6):
                    step[joint] += jacobian[row, joint] * vector[row]
            return step
    return np.linalg.pinv(jacobian, 1 / SINGULAR) @ residual


@inner
def _residual(pose: np.ndarray, goal: np.ndarray, residual: np.ndarray) -> float:
    """Write the motion (6,) from a pose to a goal, along the base's axes; return its largest part.

    The motion is the translation [m], and the rotation axis times the sine of the angle [rad]. This
    equals the angle near the solution. The sine of 180 degrees is zero, too: then the function
    returns infinity.
    """
    for row in range(3):
        residual[row] = goal[row, 3] - pose[row, 3]
        one, other = (row + 1) % 3, (row + 2) % 3
        turn = 0.0
        for column in range(3):
            turn += (
                goal[other, column] * pose[one, column] - goal[one, column] * pose[other, column]
            )
        residual[3 + row] = turn / 2
    longest = _longest(residual)
    if longest < SMALL:  # the rotation is about 0 or 180 degrees
        trace = 0.0
        for row in range(3):
            for column in range(3):
                trace += goal[row, column] * pose[row, column]
        if trace < 1:
            return np.inf
    return longest


@inner
def _longest(vector: np.ndarray) -> float:
    """The largest absolute value in a vector; nan if it contains nan."""
    longest = 0.0
    for number in vector:
        if not abs(number) <= longest:
            longest = abs(number)
            if np.isnan(longest):
                break
    return longest


@inner
def _eliminate(matrix: np.ndarray, vector: np.ndarray) -> bool:
    """Solve linear equations in place; return whether there is a solution."""
    size = len(vector)
    for column in range(size):
        pivot = column
        for row in range(column + 1, size):
            if abs(matrix[row, column]) > abs(matrix[pivot, column]):
                pivot = row
        if pivot != column:
            for other in range(column, size):
                number = matrix[column, other]
                matrix[column, other], matrix[pivot, other] = matrix[pivot, other], number
            vector[column], vector[pivot] = vector[pivot], vector[column]
        inverse = 1 / matrix[column, column]
        for row in range(column + 1, size):
            factor = matrix[row, column] * inverse
            for other in range(column + 1, size):
                matrix[row, other] -= factor * matrix[column, other]
            vector[row] -= factor * vector[column]
        matrix[column, column] = inverse
    for row in range(size - 1, -1, -1):
        total = vector[row]
        for other in range(row + 1, size):
            total -= matrix[row, other] * vector[other]
        vector[row] = total * matrix[row, row]
    return _longest(vector) <= SINGULAR


@inner
def _write_pose(
    coordinates: np.ndarray, box: Region, relative: np.ndarray, pose: np.ndarray
) -> None:
    """Write the pose at coordinates (6,); `relative` (3, 3) is a work array for a rotation."""
    half = box.half_ranges
    one, two, three = coordinates[3] * half[3], coordinates[4] * half[4], coordinates[5] * half[5]
    if box.vectors:
        _write_turn_by_vector(one, two, three, relative)
    else:
        _write_turn_by_angles(one, two, three, relative)
    _write_product(box.centre, relative, pose)
    for row in range(3):
        pose[row, 3] = box.centre[row, 3] + coordinates[row] * half[row]


@inner
def _write_coordinates(
    pose: np.ndarray, box: Region, relative: np.ndarray, coordinates: np.ndarray
) -> None:
    """Write the coordinates (6,) of a pose; `relative` (3, 3) is a work array for a rotation."""
    for row in range(3):
        coordinates[row] = pose[row, 3] - box.centre[row, 3]
    _write_product(box.centre.T, pose, relative)
    if box.vectors:
        _write_vector(relative, coordinates[3:])
    else:
        coordinates[3] = np.arctan2(relative[2, 1], relative[2, 2])
        coordinates[4] = np.arctan2(-relative[2, 0], np.hypot(relative[0, 0], relative[1, 0]))
        coordinates[5] = np.arctan2(relative[1, 0], relative[0, 0])
    for number in range(6):
        coordinates[number] /= box.half_ranges[number]


@inner
def _write_product(one: np.ndarray, other: np.ndarray, product: np.ndarray) -> None:
    """Write the product of two rotations, the first three rows and columns of their arrays."""
    for row in range(3):
        for column in range(3):
            product[row, column] = (
                one[row, 0] * other[0, column]
                + one[row, 1] * other[1, column]
                + one[row, 2] * other[2, column]
            )


@inner
def _write_row(row: np.ndarray, x: float, y: float, z: float) -> None:
    row[0], row[1], row[2] = x, y, z


@inner
def _write_turn_by_angles(roll: float, pitch: float, yaw: float, turn: np.ndarray) -> None:
    """Write the rotation Rz(yaw) Ry(pitch) Rx(roll)."""
    a, b, c = np.cos(roll), np.cos(pitch), np.cos(yaw)
    d, e, f = np.sin(roll), np.sin(pitch), np.sin(yaw)
    _write_row(turn[0], c * b, c * e * d - f * a, c * e * a + f * d)
    _write_row(turn[1], f * b, f * e * d + c * a, f * e * a - c * d)
    _write_row(turn[2], -e, b * d, b * a)


@inner
def _write_turn_by_vector(x: float, y: float, z: float, turn: np.ndarray) -> None:
    """Write the rotation exp([r]), by Rodrigues' formula."""
    angle = np.sqrt(x * x + y * y + z * z)
    part = np.sin(angle) / angle if angle > 0 else 1.0
    half = np.sin(angle / 2) / (angle / 2) if angle > 0 else 1.0
    c, s = np.cos(angle), half**2 / 2
    _write_row(turn[0], s * x * x + c, s * x * y - part * z, s * x * z + part * y)
    _write_row(turn[1], s * x * y + part * z, s * y * y + c, s * y * z - part * x)
    _write_row(turn[2], s * x * z - part * y, s * y * z + part * x, s * z * z + c)


@inner
def _write_vector(turn: np.ndarray, vector: np.ndarray) -> None:
    """Write r of exp([r]), by the quaternion formula (of four) that divides by no small number."""
    trace = turn[0, 0] + turn[1, 1] + turn[2, 2]
    first, largest = 3, trace
    for axis in range(3):
        if turn[axis, axis] > largest:
            first, largest = axis, turn[axis, axis]
    if first == 3:
        real = 1 + trace
        for axis in range(3):
            one, other = (axis + 1) % 3, (axis + 2) % 3
            vector[axis] = turn[other, one] - turn[one, other]
    else:
        one, other = (first + 1) % 3, (first + 2) % 3
        real = turn[other, one] - turn[one, other]
        vector[first] = 1 - trace + 2 * turn[first, first]
        vector[one] = turn[one, first] + turn[first, one]
        vector[other] = turn[other, first] + turn[first, other]
    length = np.sqrt(vector[0] ** 2 + vector[1] ** 2 + vector[2] ** 2)
    angle = 2 * np.arctan2(length, abs(real))
    scale = np.copysign(angle / length if length > 0 else 1.0, real)
    for axis in range(3):
        vector[axis] *= scale
