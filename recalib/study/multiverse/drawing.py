"""Drawing the universes of a design: their levels, and where their robots can work."""

import sys
from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.damaged.damage import BaseShift, Damage, apply
from recalib.errors import RecalibError
from recalib.nominal.controller import Controller
from recalib.nominal.poses import pose_errors
from recalib.numerics.randomness import generator
from recalib.study.configuration.damages import Entry
from recalib.study.configuration.part import Frozen
from recalib.study.configuration.study import PaperDamage
from recalib.study.configuration.universes import Universes
from recalib.study.multiverse.design import Designed
from recalib.study.multiverse.factors import SobolRow, rows
from recalib.study.multiverse.homes import random_home
from recalib.study.multiverse.universe import DIGITS, robot_in
from recalib.study.scenarios.assignments import Ways, compare
from recalib.study.scenarios.nominal import Nominal
from recalib.study.scenarios.plants import nominal_robot


class Setting(Frozen):
    """What a design is drawn for.

    Attributes:
        plan: how many universes, and their factors.
        robots: the study's own first.
        damage: the paper's.
        moved: by what the whole robot is.
    """

    plan: Universes
    robots: tuple[Nominal, ...]
    damage: PaperDamage
    moved: tuple[Entry, ...]


def design(setting: Setting) -> list[dict[str, Any]]:
    """The rows of the file. Raises RecalibError: there are too few.

    Of the rows of the sequence, those that a robot refuses are left out, and said so.
    """
    drawn: list[dict[str, Any]] = []
    for row in rows(setting.plan):
        try:
            drawn.append(draw(setting, len(drawn), row).as_row())
        except RecalibError as error:
            print(f"row {row.number} is refused: {error}", file=sys.stderr)
        if len(drawn) == setting.plan.count:
            return drawn
    raise RecalibError(f"only {len(drawn)} of {setting.plan.count} universes are possible")


def draw(setting: Setting, universe: int, row: SobolRow) -> Designed:
    """A universe of a row. Raises RecalibError: its robot cannot do it."""
    plan, levels = setting.plan, row.levels
    random = generator(plan.seed, "universe", row.number)
    seed = int(random.integers(2**32))
    nominal = next(robot for robot in setting.robots if robot.name == levels["robot"])
    own = setting.robots[0].robot.workspace
    nominal = robot_in(nominal, levels, own, plan.longer)
    scale = nominal.robot.workspace.scale_to(own)
    controller, refused = _controller(nominal, row, plan.home_spread, random)
    robot, joints = controller.robot, list(nominal.robot.home)
    tests = robot.workspace.sample(random, setting.damage.poses)
    ways = Ways(
        nominal.robot.links,
        [scale * length for length in setting.damage.shorten],
        joints,
        setting.damage.shift,
        levels["shortening"],
    )
    if levels["assignment"] == "any":
        damage = ways[int(row.share * len(ways))]
    else:
        few, published = tests[: plan.assignment_poses], setting.damage.published
        damage = ways[compare(controller, ways, few, published, scale, levels["error"])[1]]
    position, orientation = _initial_errors(controller, damage, tests, levels["error"])
    return Designed(
        universe=universe,
        row=row.number,
        seed=seed,
        levels={name: str(level) for name, level in levels.items()},
        home_deg=tuple(
            float(f"{np.degrees(robot.home[robot.joints.index(joint)]):.6g}") for joint in joints
        ),
        homes_refused=refused,
        moved=moved(setting.moved, scale, random if levels["displacement"] == "random" else None),
        damage=damage,
        position_error_cm=float(f"{100 * position:.4g}"),
        orientation_error_deg=float(f"{np.degrees(orientation):.4g}"),
    )


def moved(
    shifts: Sequence[Entry], scale: float, random: np.random.Generator | None
) -> tuple[BaseShift, ...]:
    """By what the whole robot is moved and turned, in random directions where they are random."""
    found = []
    for shift in shifts:
        assert isinstance(shift, BaseShift)  # checked before: `recalib.study.checks.consistency`
        lengths, turn = np.array(shift.translation), Rotation.from_euler("xyz", shift.rotation)
        if random is not None:
            ways = random.normal(size=(2, 3))
            way, axis = ways / np.linalg.norm(ways, axis=-1, keepdims=True)
            lengths = np.linalg.norm(lengths) * way
            turn = Rotation.from_rotvec(turn.magnitude() * axis)
        angles = np.degrees(turn.as_euler("xyz"))
        found.append(
            BaseShift(
                tuple((scale * lengths).round(DIGITS).tolist()),
                tuple(np.radians(angles.round(2)).tolist()),
            )
        )
    return tuple(found)


def _controller(
    nominal: Nominal, row: SobolRow, spread: float, random: np.random.Generator
) -> tuple[Controller, int]:
    """The controller at its home, and how many homes it refused before."""
    robot = nominal_robot(nominal)
    greatest = nominal.controller.greatest_condition
    if row.levels["home"] == "configured":
        return Controller(robot, greatest), 0
    return random_home(robot, spread, greatest, random)


def _initial_errors(
    controller: Controller, damage: Sequence[Damage], tests: np.ndarray, error: str
) -> tuple[float, float]:
    """Mean errors [m, rad] of the uncorrected robot."""
    workspace = controller.robot.workspace
    desired = workspace.to_poses(tests)
    achieved = apply(controller.robot, damage).forward(controller.inverse(desired))
    position, orientation = pose_errors(workspace, achieved, desired, error)
    return position.mean(), orientation.mean()
