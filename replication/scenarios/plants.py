"""Scenarios as resolved: a robot, its controller and its damages, from which a plant is made."""

from collections.abc import Sequence
from pathlib import Path
from typing import Self

import numpy as np

from recalib.damaged.damage import DamagedArm, EncoderShift, LinkShortening, apply
from recalib.damaged.plant import Plant
from recalib.nominal.controller import Controller
from recalib.nominal.poses import orientation_error, position_error
from recalib.nominal.robots import Robot, load_robot
from recalib.numerics.randomness import generator
from replication.config.damages import Assigned, Entry, damages_among, disturbances_among
from replication.config.part import Frozen
from replication.scenarios.nominal import Nominal


def nominal_robot(nominal: Nominal) -> Robot:
    """The robot that an entry of the configuration describes; see `load_robot` for its errors."""
    entry = nominal.robot
    return load_robot(
        entry.urdf,
        entry.tool,
        home=entry.home,
        position_range=entry.workspace.position,
        orientation_range=entry.workspace.orientation,
        limits=entry.limits,
        name=nominal.name,
        coordinates=entry.workspace.coordinates,
        beyond=entry.beyond,
    )


def nominal_controller(nominal: Nominal) -> Controller:
    """Its controller; see `Controller` for what it raises."""
    return Controller(nominal_robot(nominal), nominal.controller.greatest_condition)


class Kept(Frozen):
    """A typed value that a file of JSON keeps."""

    @classmethod
    def read(cls, path: str | Path) -> Self:
        """The value in a file."""
        return cls.model_validate_json(Path(path).read_bytes())


class Resolved(Kept):
    """A scenario as resolved: all that a plant is made of, as the rule `scenario` keeps it."""

    scenario: str
    robot: str
    damages: tuple[Entry, ...]
    workspace: dict[str, list]
    initial_position_error_cm: float
    initial_orientation_error_deg: float
    nominal: Nominal

    def controller(self) -> Controller:
        """The nominal controller."""
        return nominal_controller(self.nominal)

    def arm(self, robot: Robot) -> DamagedArm:
        """The damaged arm of the nominal robot."""
        return apply(robot, damages_among(self.damages))

    def plant(
        self, controller: Controller, seed: int, runs: Sequence[int], stream: str = ""
    ) -> Plant:
        """Robots for these runs, with the disturbances of their own.

        Args:
            stream: name of that of their disturbances; the scenario's unless given.
        """
        rngs = [generator(seed, stream or self.scenario, run, "disturbances") for run in runs]
        arm = self.arm(controller.robot)
        return Plant(controller, arm, disturbances_among(self.damages), rngs)


class Assignment(Kept):
    """The assignment of the paper's damage that is used, as the rule `assignments` keeps it."""

    damages: tuple[LinkShortening | EncoderShift, ...]


def resolve(
    name: str,
    nominal: Nominal,
    damages: tuple[Entry, ...],
    poses: int,
    seed: int,
    assignment: Path | None = None,
) -> Resolved:
    """A scenario with its part of the assignment put in, and the initial errors that it causes.

    Args:
        poses: random ones, over which the errors are averaged.
        assignment: file of the paper's damage as assigned to the robot, where it has a part in it.
    """
    assigned = Assignment.read(assignment).damages if assignment else ()
    resolved: list[Entry] = []
    for entry in damages:
        resolved += entry.part_of(assigned) if isinstance(entry, Assigned) else [entry]
    controller = nominal_controller(nominal)
    workspace = controller.robot.workspace
    tests = workspace.sample(generator(seed, name, "initial errors"), 1, poses)
    arm = apply(controller.robot, damages_among(resolved))
    achieved, _ = Plant(controller, arm).achieve(tests)
    desired = workspace.to_poses(tests)
    return Resolved(
        scenario=name,
        robot=nominal.name,
        damages=tuple(resolved),
        workspace={
            "centre": workspace.centre.round(6).tolist(),
            "half_ranges_m_rad": workspace.half_ranges.round(6).tolist(),
        },
        initial_position_error_cm=100 * position_error(achieved, desired).mean(),
        initial_orientation_error_deg=np.degrees(orientation_error(achieved, desired).mean()),
        nominal=nominal,
    )
