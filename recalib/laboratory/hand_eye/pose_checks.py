"""Checks of flange and board poses: whether they determine the result, and likely mistakes.

If the poses do not fit, other directions, conventions and the other mounting of the camera are
tried. Messages name the one that fits. Sizes are compared by the scale s of the board in

    R_X (s y_i) + x = R_Gi z + t_Gi,

with the rotations R_X and R_Gi of the fit.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from recalib.files.quantities import LENGTH
from recalib.identification.hand_eye import ONE_AXIS, starts
from recalib.identification.model.hand_eye_model import HandEye, Sights
from recalib.laboratory.hand_eye.pose_table import PoseTable
from recalib.laboratory.plausibility.mistakes import Mistaken
from recalib.laboratory.plausibility.steps import UNITS
from recalib.laboratory.tables.conventions import other_readings
from recalib.spelling import counted

FEWEST = 6  # poses: each has 6 numbers, for 12 unknowns
SAME = 0.01  # m, rad: poses of flange and board that differ by less are the same data
NEAREST = 0.02  # m: no camera can focus on a nearer board
ALIKE = 2.0  # deg: orientations within it count as equal
WRONG, HOPELESS = 5e-3, 50e-3  # m: largest misfit of most arms and cameras, and of any
EXPLAINED = 0.3  # the fraction of a misfit that may remain once a mistake is corrected
OPEN = 0.05, np.radians(5)  # m, rad: a result with a larger deviation is useless
LOOSE = 1e-2  # of the largest singular value: smaller ones leave a direction undetermined
OPEN_SIZE = 0.1  # component of such a direction along the scale: then the scale is undetermined
SIZE, SURE = 0.015, 5.0  # smallest error of a scale to report: relative, and in deviations
SPREAD, DISTANCE = 0.2, 0.7  # m, usual: of positions from their median; from camera to board
HELD, LONGER = 0.3, 2.0  # m; ratio of distances: an object on a flange is seldom farther away
BEHIND = -0.5  # z in the camera over the distance: the board is behind the camera
MIRROR = np.diag([1.0, 1.0, -1.0, 1.0])
TILT = "try: poses that are tilted by 20 deg or more, about two axes"


def check_motion(sights: Sights) -> None:
    """Raise Mistaken if poses are too few, the same, turned too little, or the board too near."""
    if len(sights) < FEWEST:
        found = f"{counted(len(sights), 'pose')} can be used"
        raise Mistaken(f"{found}; expected: at least {FEWEST}, better 15 or more")
    if np.allclose(sights.flange, sights.board, rtol=0, atol=SAME):
        raise Mistaken(
            "the flange's poses in the base are those of the board in the camera; try: names such"
            " as 'robot' and 'board' in a file with both"
        )
    distance = float(np.median(np.linalg.norm(sights.board[:, :3, 3], axis=1)))
    if distance < NEAREST:
        raise Mistaken(
            f"the board is {1e3 * distance:.2g} mm from the camera; expected: at least"
            f" {1e3 * NEAREST:.0f} mm; try: another unit, by --target-unit or in --board"
        )
    (most, second, _), axes = sights.axes
    if most < ALIKE:
        raise Mistaken(
            f"all poses are turned alike, within {most:.2g} deg, which does not determine where"
            f" camera and board are; {TILT}"
        )
    if second < ONE_AXIS and sights.height is None:
        axis = ", ".join(f"{number:.2f}" for number in axes[0] * np.sign(axes[0].sum()))
        raise Mistaken(
            f"all turns are about one axis, ({axis}) in the base, along which the places of camera"
            f" and board are not determined; {TILT}; for an arm with four axes, --height"
        )


def check_fit(found: HandEye, flange: PoseTable, targets: PoseTable | None) -> None:
    """Raise Mistaken if poses are likely wrong, or leave a place uncertain.

    The tables hold the poses of the fit; `targets` is None if pictures show the board.
    """
    remaining = found.misfit
    fits = remaining < WRONG
    sizes = map(board_size, [found] if fits else [found, *starts(found.sights)])
    scale, deviation, error = min(sizes, key=lambda size: size[2])
    if fits or (error < EXPLAINED * remaining and deviation < SIZE * scale):
        _check_size(found, scale, deviation, SIZE if fits else 0.0, targets is not None)
    if not fits:
        _check_height(found.sights, remaining)
        _check_readings(found.sights, flange, targets, remaining)
    for name, place in (("camera", found.camera), ("board", found.board)):
        if (far := np.linalg.norm(place[:3, 3])) > LENGTH.farthest:
            raise Mistaken(f"the {name} would be {far:.0f} m away, so the poses do not fit; {TILT}")
    for part, name in enumerate(("camera", "board")):
        position, turn = found.deviations(part)
        if position > OPEN[0] or turn > OPEN[1]:
            raise Mistaken(
                f"the {name}'s place is known to {1e3 * position:.0f} mm and"
                f" {np.degrees(turn):.1f} deg only; {TILT}, and that are decimetres apart"
            )


def _misfit(sights: Sights) -> float:
    return min(start.misfit for start in starts(sights))


def _check_height(sights: Sights, remaining: float) -> None:
    """Raise Mistaken if poses that determine the height fit much better without the given one."""
    if sights.height is None or sights.axes[0][1] < ONE_AXIS:
        return
    best = _misfit(replace(sights, height=None))
    if best < EXPLAINED * remaining:
        raise Mistaken(
            f"the poses do not fit the height ({1e3 * remaining:.3g} mm remain), but they fit"
            f" ({1e3 * best:.3g} mm) without --height; they determine the height themselves"
        )


def board_size(found: HandEye) -> tuple[float, float, float]:
    """The board's true size over the described one, given the rotations of a fit; its deviation.

    Also the median error [m] of positions with this scale, divided by it.
    """
    sights, turn = found.sights, found.camera[:3, :3]
    rows = np.flatnonzero(found.weights >= np.median(found.weights) / 4)
    between, places = sights.between[rows], sights.board[rows, :3, 3] @ turn.T
    unit = np.tile(np.eye(3), (len(rows), 1, 1))
    system = np.concatenate([places[:, :, None], unit, -between[:, :3, :3]], axis=2)
    goal, rows_of = between[:, :3, 3], system.reshape(-1, 7)
    _, strengths, directions = np.linalg.svd(rows_of, full_matrices=False)
    if np.abs(directions[strengths < LOOSE * strengths[0], 0]).max(initial=0.0) > OPEN_SIZE:
        return 1.0, np.inf, np.inf  # a flange that only turns does not determine sizes
    best = np.linalg.lstsq(rows_of, goal.ravel(), rcond=LOOSE)[0]
    errors = goal - system @ best
    variance = np.sum(errors**2) / max(1, errors.size - 7)
    spread = variance * np.linalg.pinv(rows_of.T @ rows_of, rcond=LOOSE**2)[0, 0]
    scale, remaining = float(best[0]), float(np.median(np.linalg.norm(errors, axis=1)))
    # a board that shrinks to a point fits everything
    return scale, float(np.sqrt(spread)), remaining / scale if scale > 0 else np.inf


def _check_size(found: HandEye, scale: float, deviation: float, least: float, table: bool) -> None:
    """Raise Mistaken if positions and the board differ in scale, by `least` or more.

    Args:
        table: whether the board's poses are from a table, whose positions may be wrong, too.
    """
    if abs(scale - 1) < max(least, SURE * deviation):
        return
    places = found.sights.flange[:, :3, 3]
    spread = np.median(np.linalg.norm(places - np.median(places, axis=0), axis=1))
    distance = np.median(np.linalg.norm(found.sights.board[:, :3, 3], axis=1))
    # the table whose size is farther from that of most cells
    theirs = table and abs(np.log(distance / DISTANCE)) > abs(np.log(spread / SPREAD))
    name, option = ("target", "--target-unit") if theirs else ("flange", "--unit")
    for factor, words in UNITS.items():
        if abs((1 / scale if theirs else scale) * factor - 1) < 0.1:
            raise Mistaken(
                f"the {name}'s positions are likely {words}: by those of the flange, the board is"
                f" {scale:.3g} times as large as described; try: {option}, or another unit in the"
                " heading"
            )
    differs = f"{100 * abs(scale - 1):.1f} % (deviation {100 * deviation:.1g} %)"
    differs += f" {'larger' if scale > 1 else 'smaller'} than"
    valid, lengths = "described", "lengths in --board"
    if table:
        valid, lengths = "by the target's positions", "these"
    raise Mistaken(
        f"according to the flange's positions, the board is {differs} {valid}; try:"
        f" {lengths} times {scale:.4g}, after measuring a square"
    )


def _check_readings(
    sights: Sights, flange: PoseTable, targets: PoseTable | None, remaining: float
) -> None:
    """Raise Mistaken if the poses fit much better when read in another way, or fit in no way."""
    side, option = ("fixed", "fixed") if sights.in_hand else ("on the hand", "hand")
    direction = f"the camera is {side} (--camera {option}), or"
    direction += " the flange's poses are those of the base in the flange (--inverse flange)"
    boards = [("", sights.board)]
    if targets is not None:
        direction += ", or the target's are those of the camera in the target (--inverse targets)"
        boards = [*_readings("target", "--target-convention", targets)]
    fits = []
    for theirs, board in boards:
        for ours, poses in _readings("flange", "--convention", flange):
            for way, right in (("", poses), (direction, np.linalg.inv(poses))):
                if words := ", and ".join(filter(None, (way, ours, theirs))):
                    fits.append((_misfit(replace(sights, flange=right, board=board)), words))
    best, words = min(fits, key=lambda fit: fit[0])
    remain = f"({1e3 * remaining:.3g} mm remain)"
    if best < EXPLAINED * _misfit(sights):
        but = f"but they do ({1e3 * best:.3g} mm) if {words}"
        raise Mistaken(f"the poses do not fit as they are read {remain}, {but}")
    if remaining > HOPELESS:
        raise Mistaken(
            f"the poses do not fit in any direction and convention {remain}; are rows and"
            " pictures in the same order?"
        )


def exchange_in(found: HandEye, by_table: bool) -> str | None:
    """A warning about two mistakes that fit together, such as two inverted tables; None without.

    They exchange camera and board, or the object on the flange and the object in the base.

    Args:
        by_table: whether a table has the board's poses; those from pictures cannot be inverted.
    """
    in_hand, board = found.sights.in_hand, found.sights.board[:, :3, 3]
    ends = [("camera", found.camera), ("board", found.board)]
    (held, on_it), (other, in_it) = ends if in_hand else ends[::-1]  # flange, then base
    on_flange, in_base = (float(np.linalg.norm(pose[:3, 3])) for pose in (on_it, in_it))
    far = on_flange > max(HELD, LONGER * in_base)
    behind = np.median(board[:, 2] / np.linalg.norm(board, axis=1)) < BEHIND
    side = f"--camera {'fixed' if in_hand else 'hand'}"
    if far:
        tries = ["--inverse flange targets"] * by_table + [f"--inverse flange and {side}"]
        return (
            f"the {held} would be {1e3 * on_flange:.0f} mm from the flange, and the {other}"
            f" {1e3 * in_base:.0f} mm from the base's origin; if they are not, try: "
            f"{' or '.join(tries[: 1 if behind else 2])}"
        )
    if behind:
        found_at = "the board would be behind the camera, whose z axis points ahead"
        return f"{found_at}; if it does, try: --inverse targets and {side}"
    return None


def _readings(name: str, option: str, table: PoseTable) -> Iterator[tuple[str, np.ndarray]]:
    """Poses as read, without words, and with the rotations read in other ways, in words."""
    yield "", table.poses
    yield "the poses of one table are of a left-handed frame", MIRROR @ table.poses @ MIRROR
    for words, turns in other_readings(table.turns):
        poses = replace(table, rotations=turns).poses
        yield f"the {name}'s rotations are {words} ({option})", poses
