"""Resolved scenarios: a robot, its controller and its damages, which determine a plant."""

import hashlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Self

from recalib.damaged.damage import DamagedArm, apply
from recalib.damaged.disturbances import Disturbance, Disturbances
from recalib.damaged.plant import Plant
from recalib.nominal.controller import Controller
from recalib.nominal.descriptions import find_urdf
from recalib.nominal.robots import Robot, load_robot
from recalib.numerics.randomness import generator
from replication.config.damages import Entry, damages_among
from replication.config.part import Frozen
from replication.config.study import ControllerSettings, RobotSettings, Study


class Nominal(Frozen):
    """A robot and its controller."""

    name: str
    robot: RobotSettings
    controller: ControllerSettings
    urdf_sha256: str
    """Digest of the file `robot.urdf`, because results depend on its content."""


def nominal_of(study: Study, robot: str) -> Nominal:
    """A robot of a study, by its name. Raises like `find_urdf`."""
    entry = study.robots[robot]
    digest = hashlib.sha256(find_urdf(entry.urdf).read_bytes()).hexdigest()
    return Nominal(name=robot, robot=entry, controller=study.controller, urdf_sha256=digest)


def nominal_robot(nominal: Nominal) -> Robot:
    """The robot that an entry of the configuration describes. Raises like `load_robot`."""
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
    """The controller of a nominal robot. Raises like `Controller`."""
    return Controller(nominal_robot(nominal), nominal.controller.greatest_condition)


class Resolved(Frozen):
    """A resolved scenario: everything that determines a plant. It is stored as JSON."""

    scenario: str
    robot: str
    damages: tuple[Entry, ...]
    workspace: dict[str, list[Any]]
    initial_position_error_cm: float
    initial_orientation_error_deg: float
    nominal: Nominal

    @classmethod
    def read(cls, path: str | Path) -> Self:
        """The scenario in a file."""
        return cls.model_validate_json(Path(path).read_bytes())

    def controller(self) -> Controller:
        """The nominal controller."""
        return nominal_controller(self.nominal)

    def arm(self, robot: Robot) -> DamagedArm:
        """The damaged arm of the nominal robot."""
        return apply(robot, damages_among(self.damages))

    def plant(self, controller: Controller, seed: int, runs: Sequence[int]) -> Plant:
        """A plant with a robot for each run; each has its own random disturbances."""
        rngs = [generator(seed, self.scenario, run, "disturbances") for run in runs]
        parts = [entry for entry in self.damages if isinstance(entry, Disturbance)]
        disturbances = Disturbances.of(parts) if parts else None
        return Plant(controller, self.arm(controller.robot), disturbances, rngs)
