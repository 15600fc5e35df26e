"""All assignments of the paper's damage to links, encoders and signs (section 7).

The paper gives the amounts by which three links were shortened and three encoders were shifted, and
the initial errors. It gives neither the links and encoders nor the signs.
"""

from collections.abc import Sequence
from itertools import permutations, product

import numpy as np

from recalib.damaged.damage import Along, EncoderShift, LinkShortening, apply
from recalib.nominal.controller import Controller
from recalib.nominal.workspace import pose_errors
from recalib.numerics.randomness import generator
from replication.config.study import PaperDamage, Published
from replication.scenarios.plants import Nominal, nominal_controller

TIE = 9  # decimals of a distance; rounding errors must not decide between equal ones


def _distinct(
    names: Sequence[str], choices: Sequence[Sequence[float]]
) -> list[list[tuple[str, float]]]:
    """All assignments of the amounts in a choice to different names, in the names' order."""
    ways = dict.fromkeys(
        tuple(sorted(zip(chosen, amounts, strict=True)))
        for chosen in permutations(range(len(names)), len(choices[0]))
        for amounts in choices
    )
    return [[(names[place], amount) for place, amount in way] for way in ways]


class Ways:
    """All assignments of the paper's damage to a robot, in a fixed order.

    Args:
        links: candidates for the lengths [m].
        joints: candidates for the encoder shifts [rad], which have either sign.
        along: direction in which links are shortened; see `LinkShortening`.
    """

    def __init__(
        self,
        links: Sequence[str],
        lengths: Sequence[float],
        joints: Sequence[str],
        angles: Sequence[float],
        along: Along = "line",
    ):
        signed = list(product(*((angle, -angle) for angle in angles)))
        self.short = [
            tuple(LinkShortening(link, length, along) for link, length in way)
            for way in _distinct(links, [lengths])
        ]
        self.shifted = [
            tuple(EncoderShift(joint, angle) for joint, angle in way)
            for way in _distinct(joints, signed)
        ]

    def __len__(self) -> int:
        return len(self.short) * len(self.shifted)

    def __getitem__(self, index: int) -> tuple[LinkShortening | EncoderShift, ...]:
        """The damages of one assignment, links first, each from the base to the tool."""
        short, shifted = divmod(int(index), len(self.shifted))
        return (*self.short[short], *self.shifted[shifted])


Assignment = tuple[LinkShortening | EncoderShift, ...]


def assign(
    nominal: Nominal, damage: PaperDamage, seed: int
) -> tuple[dict[str, np.ndarray], Assignment]:
    """All assignments of the paper's damage to a robot, and the one nearest to published errors.

    Returns the columns of a table with a row for each of `Ways`: the mean initial errors
    position_error_cm and orientation_error_deg, and `distance`, the larger of their relative
    deviations from the published errors. Among equally near assignments the first is chosen.
    """
    controller = nominal_controller(nominal)
    robot = controller.robot
    ways = Ways(nominal.robot.links, damage.shorten, robot.joints, damage.shift)
    poses = robot.workspace.sample(generator(seed, "assignments"), damage.poses)
    table, nearest = compare(controller, ways, poses, damage.published)
    return table, ways[nearest]


def compare(
    controller: Controller,
    ways: Ways,
    coordinates: np.ndarray,
    published: Published,
    scale: float = 1.0,
    error: str = "norm",
) -> tuple[dict[str, np.ndarray], int]:
    """The table of `assign` for these ways, and the row nearest to the published errors.

    Args:
        coordinates: (n, 6) desired poses over which the errors are averaged.
        scale: size of the robot's workspace, relative to that of the study's robot.
        error: definition of a pose's errors; see `recalib.nominal.workspace.pose_errors`.
    """
    robot = controller.robot
    desired = robot.workspace.to_poses(coordinates)
    angles = controller.inverse(desired)
    offsets = np.array([apply(robot, shift).offsets for shift in ways.shifted])
    shifted = (angles + offsets[:, None]).reshape(-1, angles.shape[1])
    errors = []
    for shortening in ways.short:
        achieved = apply(robot, shortening).chain.forward(shifted[None])
        achieved = achieved.reshape(len(ways.shifted), len(desired), 4, 4)
        both = pose_errors(robot.workspace, achieved, desired, error)
        errors.append([values.mean(axis=1) for values in both])
    position, orientation = np.concatenate(errors, axis=1)
    table = {
        "position_error_cm": 100 * position / scale,
        "orientation_error_deg": np.degrees(orientation),
    }
    distances = [np.abs(table[name] / value - 1) for name, value in published]
    table["distance"] = np.maximum(*distances)
    return table, int(table["distance"].round(TIE).argmin())
