"""Draw the setups of the design: levels of all factors, and a feasible home for each robot."""

import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import product
from typing import Any, NamedTuple

import numpy as np
from scipy.stats.qmc import LatinHypercube

from recalib.damaged.damage import Damage, apply
from recalib.errors import RecalibError, UnfitWorkspace
from recalib.nominal.chain import TOLERANCE, Chain
from recalib.nominal.controller import Controller
from recalib.nominal.robots import Robot
from recalib.nominal.workspace import pose_errors
from recalib.numerics.randomness import generator
from replication.campaign.setups import Setup, robot_in
from replication.config.campaign import Campaign, Factors
from replication.config.study import Study
from replication.scenarios.assignments import Ways, assign, compare
from replication.scenarios.plants import Nominal, nominal_controller, nominal_of, nominal_robot

CORNERS = np.array(list(product((-1.0, 1.0), repeat=6)))
CANDIDATES = 30000  # the most restrictive arm, with a longer tool, accepts one home in 10,000
BATCHES = 3  # of rows; the second and third replace rows that a robot refuses


class Row(NamedTuple):
    """A row of the design."""

    number: int  # 0 is the reference study, with the first level of each factor
    levels: dict[str, Any]  # the level of each factor
    share: float  # in [0, 1), selects one of all assignments of the damage, if the level is "any"


def rows(plan: Campaign) -> Iterator[Row]:
    """The rows of the design, followed by replacements for rows that a robot refuses.

    The first row is the reference study. The rest is a Latin hypercube: the levels of each factor
    occur equally often, and factors are almost uncorrelated.
    """
    factors = {name: getattr(plan.factors, name) for name in Factors.model_fields}
    yield Row(0, {name: levels[0] for name, levels in factors.items()}, 0.0)
    number = 0
    for batch in range(BATCHES):
        random = np.random.default_rng([plan.seed, batch])
        sampler = LatinHypercube(len(factors) + 1, optimization="random-cd", rng=random)
        for *numbers, share in sampler.random(plan.setups - 1).tolist():
            number += 1
            pairs = zip(factors.items(), numbers, strict=True)
            drawn = {name: levels[int(u * len(levels))] for (name, levels), u in pairs}
            yield Row(number, drawn, share)


def design(study: Study) -> list[dict[str, Any]]:
    """The rows of the design's table. Raises RecalibError if too many rows are infeasible.

    Rows of the sequence that a robot refuses are reported and skipped.
    """
    drawn: list[dict[str, Any]] = []
    for row in rows(study.campaign):
        try:
            drawn.append(draw(study, len(drawn), row).as_row())
        except RecalibError as error:
            print(f"row {row.number} is refused: {error}", file=sys.stderr)
        if len(drawn) == study.campaign.setups:
            return drawn
    raise RecalibError(f"only {len(drawn)} of {study.campaign.setups} setups are possible")


def draw(study: Study, number: int, row: Row) -> Setup:
    """The setup of a row. Raises RecalibError if the robot cannot reach the workspace."""
    plan, levels, damage = study.campaign, row.levels, study.paper_damage
    random = generator(plan.seed, "setup", row.number)
    seed = int(random.integers(2**32))
    nominal = robot_in(nominal_of(study, levels["robot"]), levels, study)
    if levels["home"] == "random":
        controller, refused = random_home(nominal, plan.home_spread, random)
    else:
        controller, refused = nominal_controller(nominal), 0
    robot = controller.robot
    tests = robot.workspace.sample(random, damage.poses)
    if row.number == 0:  # the reference study's own assignment, from its own poses
        entries = assign(nominal, damage, study.seed)[1]
    else:
        ways = ways_in(nominal, levels, study)
        if levels["assignment"] == "any":
            entries = ways[int(row.share * len(ways))]
        else:
            scale = nominal.robot.workspace.scale_to(study.robots[study.robot].workspace)
            nearest = compare(controller, ways, tests, damage.published, scale, levels["error"])[1]
            entries = ways[nearest]
    position, orientation = initial_errors(controller, entries, tests, levels["error"])
    return Setup(
        setup=number,
        row=row.number,
        seed=seed,
        levels={name: str(level) for name, level in levels.items()},
        home_deg=tuple(
            float(f"{np.degrees(robot.home[robot.joints.index(joint)]):.6g}")
            for joint in nominal.robot.home
        ),
        homes_refused=refused,
        damage=entries,
        position_error_cm=float(f"{position:.4g}"),
        orientation_error_deg=float(f"{orientation:.4g}"),
    )


def random_home(
    nominal: Nominal, spread: float, random: np.random.Generator
) -> tuple[Controller, int]:
    """The controller at the first random home that it accepts, and the number of refused homes.

    Args:
        spread: rad, greatest distance of each joint from the robot's home, within its limits.
        random: the generator that draws homes, in whole degrees.

    Raises UnfitWorkspace.
    """
    robot = nominal_robot(nominal)
    low = np.ceil(np.degrees(np.maximum(robot.home - spread, robot.lower)))
    high = np.floor(np.degrees(np.minimum(robot.home + spread, robot.upper)))
    chain = Chain.of(robot.arm)
    for refused in range(CANDIDATES):
        home = np.radians(random.integers(low, high, endpoint=True))
        workspace = replace(robot.workspace, centre=robot.arm.forward(home[None])[0])
        candidate = replace(robot, home=home, workspace=workspace)
        if _reaches_corners(candidate, chain):
            try:
                return Controller(candidate, nominal.controller.greatest_condition), refused
            except UnfitWorkspace:
                pass
    raise UnfitWorkspace(f"the {robot.name}'s controller refuses all of {CANDIDATES} random homes")


def _reaches_corners(robot: Robot, chain: Chain) -> bool:
    """Whether the arm reaches the corners of its workspace: a fast test that most homes fail."""
    for corners in (CORNERS[::9], CORNERS):
        angles = np.tile(robot.home, (len(corners), 1))
        for part in (0.5, 1):  # from home outwards: all corners on the same branch of solutions
            angles, residuals = chain.solve(robot.workspace.to_poses(part * corners), angles)
            within = (robot.lower <= angles) & (angles <= robot.upper)
            if not (np.all(residuals <= TOLERANCE) and within.all()):
                return False
    return True


def ways_in(nominal: Nominal, levels: Mapping[str, Any], study: Study) -> Ways:
    """All assignments of the paper's damage, with lengths in proportion to the workspace."""
    damage, entry = study.paper_damage, nominal.robot
    scale = entry.workspace.scale_to(study.robots[study.robot].workspace)
    lengths = [scale * length for length in damage.shorten]
    return Ways(entry.links, lengths, list(entry.home), damage.shift, levels["shortening"])


def initial_errors(
    controller: Controller, damage: Sequence[Damage], tests: np.ndarray, error: str
) -> np.ndarray:
    """Mean errors [cm, degrees] of the arm without correction."""
    workspace = controller.robot.workspace
    desired = workspace.to_poses(tests)
    achieved = apply(controller.robot, damage).forward(controller.inverse(desired))
    errors = pose_errors(workspace, achieved, desired, error)
    return np.array([values.mean() for values in errors]) * (100, np.degrees(1))
