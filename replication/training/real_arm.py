"""Learning from laser tracker data of a real arm, and on a twin identified from these data."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import cast

import numpy as np
import pandas as pd
import pinocchio as pin

from recalib.damaged.plant import Plant
from recalib.identification.calibration import Calibration
from recalib.identification.model.observations import Observations
from recalib.learners.geometric import GeometricLearner
from recalib.learners.kinds import KINEMATICS, class_of
from recalib.learners.observer import Observer
from recalib.nominal.controller import Controller
from recalib.nominal.kinematics import Arm
from recalib.nominal.robots import Robot
from recalib.nominal.workspace import POSITION, Workspace
from recalib.numerics.randomness import generator
from replication.config.study import Study
from replication.scenarios.plants import nominal_of, nominal_robot
from replication.training.competitors import MOVES, TWIN, UNCORRECTED, Peer, peers
from replication.training.poses import Stream, train_for_results
from replication.training.tracker import TrackerMeasurements, read_of, read_whole_description
from replication.training.tuned import Tuned

ROUNDING = 1e-9  # m, rad: a smaller extent of poses is zero, by which one must not divide


def with_tool_point(robot: Robot, point: np.ndarray) -> Robot:
    """The robot with its tool and workspace moved to a point (3,) [m] in the tool's frame."""
    arm = robot.arm.copy()
    tool = arm.end
    tool.placement = tool.placement * pin.SE3(np.eye(3), np.array(point))
    workspace = replace(robot.workspace, centre=arm.forward(robot.home[None])[0])
    return replace(robot, arm=arm, workspace=workspace)


def identified(kind: str, arm: Arm, measurements: TrackerMeasurements) -> Calibration:
    """The arm, identified by a kind of learner that knows the nominal kinematics."""
    identifying = cast(type[GeometricLearner], class_of(kind))
    return identifying.identify(arm, Observations(measurements.angles, measurements.measured))


def _black_box(
    peer: Peer, robot: Robot, known: TrackerMeasurements, unknown: TrackerMeasurements
) -> np.ndarray:
    """Position errors (m, 3) [m]: for a measured pose, the learner should repeat its command."""
    arm, commanded = robot.arm, robot.arm.forward(known.angles)
    centre = commanded[
        np.linalg.norm(known.angles - np.median(known.angles, axis=0), axis=1).argmin()
    ]
    reach = np.abs(Workspace(centre, np.ones(6)).to_coordinates(commanded)).max(axis=0)
    workspace = Workspace(centre, np.where(reach > ROUNDING, reach, 1.0))
    learner = cast(Observer, class_of(peer.kind).from_settings(peer.settings, 1, robot))
    sent, achieved = _coordinates(arm, workspace, known)
    learner.observe(sent, achieved, np.ones(sent.shape[:2], dtype=bool))
    sent, achieved = _coordinates(arm, workspace, unknown)
    return (sent - learner.command(achieved))[0, :, POSITION] * workspace.half_ranges[POSITION]


def _coordinates(
    arm: Arm, workspace: Workspace, measurements: TrackerMeasurements
) -> tuple[np.ndarray, np.ndarray]:
    """Commanded and achieved coordinates (1, n, 6).

    Orientations were not measured; the achieved ones are assumed to be as commanded.
    """
    commanded = arm.forward(measurements.angles)
    achieved = commanded.copy()
    achieved[:, :3, 3] = measurements.measured
    return workspace.to_coordinates(commanded)[None], workspace.to_coordinates(achieved)[None]


def remaining_errors(
    learner: str, robot: Robot, known: TrackerMeasurements, unknown: TrackerMeasurements
) -> np.ndarray:
    """Remaining position errors (m,) [m] of a peer at poses from which it has not learned.

    Args:
        robot: the nominal robot, with its tool at the measured point; see `with_tool_point`.
        known, unknown: measurements to learn from, and to test on.
    """
    peer = peers()[learner]
    if learner == UNCORRECTED:
        errors = unknown.measured - unknown.nominal
    elif peer.needs == KINEMATICS:
        reached = identified(peer.kind, robot.arm, known).forward(unknown.angles)
        errors = unknown.measured - reached[:, :3, 3]
    else:
        errors = _black_box(peer, robot, known, unknown)
    return np.linalg.norm(errors, axis=-1)


def learn(
    study: Study,
    learner: str,
    fit: Path,
    test: Path,
    description: Path,
    settings: Sequence[Path],
) -> pd.DataFrame:
    """Train a learner on poses in the table `fit`, and test it on poses in the table `test`.

    A learner that chooses its poses itself learns on a twin, identified from all poses in `fit`.
    The file `description` has frames, units and columns of the tables.

    Returns a row for each number of poses (or moves on the twin) and random subset, with the mean
    error in mm.
    """
    described = read_whole_description(description)
    assert described.target is not None  # `read_whole_description` has checked this
    nominal = nominal_robot(nominal_of(study, study.real.robot))
    robot = with_tool_point(nominal, described.target[:3, 3])
    known = read_of(robot.arm, fit, described)
    if learner in study.real.twin:
        return _on_twin(study, learner, robot, known, Tuned(study, settings))
    tests, rows = read_of(robot.arm, test, described), []
    for count in study.real.poses:
        # All poses form a single subset, and a learner that does not learn needs only one.
        once = count >= len(known) or learner == UNCORRECTED
        for subset in range(1 if once else study.real.subsets):
            order = generator(study.seed, "real", count, subset).permutation(len(known))
            errors = remaining_errors(learner, robot, known[order[:count]], tests)
            cells = {"learner": learner, "twin": False, "poses": count, "subset": subset}
            rows.append(cells | {"position_error_mm": 1e3 * errors.mean()})
    return pd.DataFrame(rows)


def _on_twin(
    study: Study, learner: str, robot: Robot, known: TrackerMeasurements, tuned: Tuned
) -> pd.DataFrame:
    twin = identified(peers()[TWIN].kind, robot.arm, known)
    iterations, runs = study.real.twin[learner], range(study.real.subsets)
    measured = {count // MOVES for count in study.real.poses if count // MOVES <= iterations}
    history = train_for_results(
        Plant(Controller(robot, study.controller.greatest_condition), twin),
        tuned.learner(learner, iterations, len(runs)),
        Stream.TWIN.draw(study.seed, runs, iterations, study.training.tests),
        sorted(measured | {iterations}),
    )
    return pd.DataFrame(
        {
            "learner": learner,
            "twin": True,
            "poses": np.tile(history.moves, len(runs)),
            "subset": np.repeat(runs, len(history.moves)),
            "position_error_mm": 1e3 * history.position[..., 0].ravel(),
        }
    )
