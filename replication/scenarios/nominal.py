"""The robot as its controller models it, as an argument of jobs."""

import hashlib

from recalib.nominal.descriptions import find_urdf
from replication.config.part import Frozen
from replication.config.study import ControllerSettings, RobotSettings, Study


class Nominal(Frozen):
    """A robot and its controller."""

    name: str
    robot: RobotSettings
    controller: ControllerSettings
    urdf_sha256: str
    """Digest of the file that `robot.urdf` means: results follow from what stands in it."""


def nominal_of(study: Study, robot: str) -> Nominal:
    """A robot of a study. See `find_urdf` for what it raises."""
    entry = study.robots[robot]
    digest = hashlib.sha256(find_urdf(entry.urdf).read_bytes()).hexdigest()
    return Nominal(name=robot, robot=entry, controller=study.controller, urdf_sha256=digest)
