"""Scenarios as resolved: a robot, its controller and its damages, from which a plant is made."""

from collections.abc import Sequence

import numpy as np

from recalib.damaged.damage import DamagedArm, apply
from recalib.damaged.fleet import Fleet
from recalib.damaged.plant import Plant
from recalib.nominal.controller import Controller
from recalib.nominal.poses import orientation_error, position_error
from recalib.nominal.robots import Robot, load_robot
from recalib.randomness import generator
from recalib.study import jobs
from recalib.study.configuration.damages import (
    Assigned,
    Entry,
    damages_among,
    disturbances_among,
)
from recalib.study.kept import Kept


def nominal_robot(nominal: jobs.Nominal) -> Robot:
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


def nominal_controller(nominal: jobs.Nominal) -> Controller:
    """Its controller; see `Controller` for what it raises."""
    return Controller(nominal_robot(nominal), nominal.controller.greatest_condition)


class Resolved(Kept):
    """A scenario as resolved: all that a plant is made of, as the rule `scenario` keeps it."""

    scenario: str
    robot: str
    damages: tuple[Entry, ...]
    workspace: dict[str, list]
    initial_position_error_cm: float
    initial_orientation_error_deg: float
    nominal: jobs.Nominal

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
            controller: the scenario's.
            seed: of the study.
            stream: name of that of their disturbances; the scenario's unless given.
        """
        luck = [generator(seed, stream or self.scenario, run, "disturbances") for run in runs]
        arm = self.arm(controller.robot)
        return Plant(controller, [arm], disturbances_among(self.damages), luck)


def fleet(
    scenarios: Sequence[Resolved], seed: int, runs: Sequence[int]
) -> tuple[Controller, Fleet]:
    """The controller and the robots of several scenarios of one robot, side by side."""
    controller = scenarios[0].controller()
    return controller, Fleet(controller, [each.plant(controller, seed, runs) for each in scenarios])


def resolve(job: jobs.Scenario, assignment: Sequence[Entry] = ()) -> Resolved:
    """The scenario with its part of the assignment put in, and the initial errors that it causes.

    Args:
        assignment: of the paper's damage to the robot.
    """
    damages: list[Entry] = []
    for entry in job.damages:
        damages += entry.part_of(assignment) if isinstance(entry, Assigned) else [entry]
    controller = nominal_controller(job.nominal)
    workspace = controller.robot.workspace
    tests = workspace.sample(generator(job.seed, job.name, "initial errors"), 1, job.poses)
    arm = apply(controller.robot, damages_among(damages))
    achieved, _ = Plant(controller, [arm]).achieve(tests)
    desired = workspace.to_poses(tests)
    return Resolved(
        scenario=job.name,
        robot=job.nominal.name,
        damages=tuple(damages),
        workspace={
            "centre": workspace.centre.round(6).tolist(),
            "half_ranges_m_rad": workspace.half_ranges.round(6).tolist(),
        },
        initial_position_error_cm=100 * position_error(achieved, desired).mean(),
        initial_orientation_error_deg=np.degrees(orientation_error(achieved, desired).mean()),
        nominal=job.nominal,
    )
