"""Learners from the files of what they learned (`recalib.learners.learned`)."""

import numpy as np

from recalib.errors import InvalidSetting, OtherRobot
from recalib.files.archives import refused
from recalib.learners.kinds import class_of
from recalib.learners.learned import WRITER, Path, differences, identity, read
from recalib.loop.interfaces import Savable
from recalib.nominal.robots import Robot


def load(path: Path, robot: Robot, run: int | None = None) -> Savable:
    """The learner that `save` wrote, for the same robot.

    Args:
        run: the one to load; all of them unless given.

    Raises InvalidFile (not whole, or no such file), OtherRobot, and InvalidSetting (no such run).
    """
    header, states = read(path)
    with refused(path, WRITER):
        if found := differences(header["robot"], identity(robot)):
            raise OtherRobot(path, found)
        settings = header["settings"]
        if run is not None:
            if not 0 <= run < len(states):
                raise InvalidSetting("run", run, f"0 to {len(states) - 1}")
            states = [states[run]]
            if "by_run" in settings:
                settings["by_run"] = [settings["by_run"][run]]
        learner = class_of(header["kind"]).from_settings(settings, len(states), robot)
        learner.restore(states)
        centre = np.zeros((len(states), 1, 6))
        if not np.isfinite(learner.command(centre)).all():
            raise ValueError
    return learner
