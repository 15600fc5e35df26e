"""Learners from the files of what they learned (`recalib.learned`)."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from recalib.archives import refused
from recalib.errors import InvalidSetting, OtherRobot, UnknownName
from recalib.interfaces import Savable
from recalib.learned import KINDS, WRITER, Path, differences, identity, read
from recalib.nominal.controller import Controller
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
        learner = _build(header["kind"], settings, len(states), robot)
        learner.restore(states)
        centre = np.zeros((len(states), 1, 6))
        if not np.isfinite(learner.command(centre)).all():
            raise ValueError
    return learner


def _build(kind: str, settings: Mapping[str, Any], runs: int, robot: Robot) -> Savable:
    # Imported where they are used: the maps need not wait for SciPy.
    match kind:
        case "hierarchical":
            from recalib.learners.hierarchical import HierarchicalLearner
            from recalib.learners.rules import Rules
            from recalib.learners.schedules import Schedule

            rules = {
                name: tuple(value) if isinstance(value, list) else value
                for name, value in settings["rules"].items()
            }
            schedules = [Schedule(**each) for each in settings["by_run"]]
            return HierarchicalLearner(runs, Rules(**rules), Schedule.of_runs(schedules))
        case "polynomial":
            from recalib.learners.polynomial import PolynomialLearner

            return PolynomialLearner(runs, **settings)
        case "gaussian_process":
            from recalib.learners.gaussian_process import GaussianProcessLearner

            return GaussianProcessLearner(runs)
        case "geometric":
            from recalib.learners.geometric import GeometricLearner

            return GeometricLearner(runs, _controller(robot))
        case "hybrid":
            from recalib.learners.hybrid import HybridLearner

            return HybridLearner(runs, _controller(robot))
    raise UnknownName("kind of learner", kind, KINDS)


def _controller(robot: Robot) -> Controller:
    """The one behind which the learner learned, whose singularity margin was accepted then."""
    return Controller(robot, greatest_condition=math.inf)
