"""Which links, which encoders, which signs? Every way to assign the paper's damage to a robot (section 7).

The paper says that three links lost 1, 1 and 4 cm and that three encoders were shifted by 4, 3 and 4 degrees, and that the
initial errors were 8.3 cm and 4.7 degrees. It says neither which links and encoders nor which signs.
"""

from collections.abc import Iterator, Sequence
from itertools import permutations, product

import numpy as np
import pandas as pd

from recalib.damaged.damage import EncoderShift, LinkShortening, apply
from recalib.nominal.controller import Controller
from recalib.nominal.poses import orientation_error, position_error


def shortenings(links: Sequence[str], lengths: Sequence[float]) -> list[tuple[LinkShortening, ...]]:
    """Every way to take the lengths [m] off as many different links."""
    ways = dict.fromkeys(
        tuple(sorted(zip(chosen, lengths, strict=True)))
        for chosen in permutations(links, len(lengths))
    )
    return [tuple(LinkShortening(link, length) for link, length in way) for way in ways]


def shifts(joints: Sequence[str], angles: Sequence[float]) -> list[tuple[EncoderShift, ...]]:
    """Every way to shift as many different encoders by the angles [rad], each in either direction."""
    ways = dict.fromkeys(
        tuple(sorted(zip(chosen, signed, strict=True)))
        for chosen in permutations(joints, len(angles))
        for signed in product(*((angle, -angle) for angle in angles))
    )
    return [tuple(EncoderShift(joint, angle) for joint, angle in way) for way in ways]


def initial_errors(
    controller: Controller,
    short: Sequence[tuple[LinkShortening, ...]],
    shifted: Sequence[tuple[EncoderShift, ...]],
    coordinates: np.ndarray,
) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Mean position [m] and orientation errors [rad] of the uncorrected robot, (len(shifted),) for each of `short`.

    Args:
        coordinates: (n, 6) desired poses over which the errors are averaged.
    """
    robot = controller.robot
    desired = robot.workspace.to_poses(coordinates)
    angles = controller.inverse(desired)
    offsets = np.array([apply(robot, shift).offsets for shift in shifted])
    believed = (angles + offsets[:, None]).reshape(-1, angles.shape[1])
    for shortening in short:
        achieved = (
            apply(robot, shortening).arm.forward(believed).reshape(len(shifted), len(desired), 4, 4)
        )
        yield (
            position_error(achieved, desired).mean(axis=1),
            orientation_error(achieved, desired).mean(axis=1),
        )


def enumerate_assignments(
    controller: Controller,
    links: Sequence[str],
    lengths: Sequence[float],
    angles: Sequence[float],
    coordinates: np.ndarray,
) -> pd.DataFrame:
    """The initial errors of every assignment of `lengths` [m] to `links` and of `angles` [rad] to the encoders.

    Returns: a row for each assignment, with a column for each link (`shorten LINK` [m], zero where it is whole), one for
    each joint (`shift JOINT` [rad]), and the mean initial errors position_error_cm and orientation_error_deg.
    """
    joints = controller.robot.joints
    short, shifted = shortenings(links, lengths), shifts(joints, angles)
    rows = []
    for shortening, errors in zip(
        short, initial_errors(controller, short, shifted, coordinates), strict=True
    ):
        off = {f"shorten {damage.link}": damage.length for damage in shortening}
        for shift, position, orientation in zip(shifted, *errors, strict=True):
            row = {
                "position_error_cm": position * 100,
                "orientation_error_deg": np.degrees(orientation),
            }
            rows.append(row | off | {f"shift {damage.joint}": damage.angle for damage in shift})
    columns = [f"shorten {link}" for link in links] + [f"shift {joint}" for joint in joints]
    return pd.DataFrame(
        rows, columns=[*columns, "position_error_cm", "orientation_error_deg"]
    ).fillna(0.0)


def distance_to(
    table: pd.DataFrame, position_error_cm: float, orientation_error_deg: float
) -> pd.Series:
    """How far each assignment's initial errors are from the published ones: the larger of the two relative deviations."""
    position = (table["position_error_cm"] / position_error_cm - 1).abs()
    orientation = (table["orientation_error_deg"] / orientation_error_deg - 1).abs()
    return np.maximum(position, orientation)


def damages_of(row: pd.Series) -> tuple[LinkShortening | EncoderShift, ...]:
    """The damages of one row of `enumerate_assignments`, links first."""
    links = [
        LinkShortening(key[8:], value)
        for key, value in row.items()
        if key.startswith("shorten ") and value
    ]
    encoders = [
        EncoderShift(key[6:], value)
        for key, value in row.items()
        if key.startswith("shift ") and value
    ]
    return (*links, *encoders)
