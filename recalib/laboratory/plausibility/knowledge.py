"""Checks of described frames and distances against the measurements.

A description is accepted if the errors of some real arm could explain it. A rotation of the wrong
sign, inches, or the frame of something else would need a different arm.
"""

from contextlib import suppress
from dataclasses import replace
from itertools import combinations

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.identification.initial_estimate import (
    FARTHEST,
    NoInitialEstimate,
    initial_frames,
    joined_frames,
    median_error,
)
from recalib.identification.model.frames import Frames
from recalib.identification.model.observations import Observations
from recalib.laboratory.data_set import DataSet
from recalib.laboratory.plausibility.mistakes import Mistaken, likely_mistake
from recalib.laboratory.tables.description import Description
from recalib.nominal.kinematics import Arm

ALIKE = 2.0  # times the least error: explanations within it are equally good
STRETCHED = 0.2  # of a distance: no arm is longer or shorter than its URDF by more


def checked_frames(arm: Arm, observations: Observations, known: Description) -> Frames:
    """Initial estimates of the frames at both ends of the nominal arm, with the stated deviations.

    Raises Mistaken if the measurements fit only without a described frame, and NoInitialEstimate,
    with the likely mistake if there is one, if they do not fit at all.
    """
    described = {"base": known.instrument, "target": known.target}
    stated = {name: pose for name, pose in described.items() if pose is not None}
    given = {name: np.linalg.inv(pose) if name == "base" else pose for name, pose in stated.items()}
    try:
        return known.stated_in(initial_frames(arm, observations, **given))
    except NoInitialEstimate as error:
        problem = error
    without, errors, tool = {}, {}, arm.forward(observations.joints)
    for wrong in [*combinations(given, 1), *combinations(given, 2)]:
        right = {name: pose for name, pose in given.items() if name not in wrong}
        with suppress(NoInitialEstimate):
            without[wrong] = initial_frames(arm, observations, **right)
            errors[wrong] = median_error(without[wrong], tool, observations)
    if not without:
        mistake = mistake_in(arm, observations)
        if mistake is None and observations.kinds == 2:
            with suppress(NoInitialEstimate):
                initial_frames(arm, replace(observations, measured=observations.positions))
                turned = "rotations of another frame or in another notation"
                mistake = f"{turned}, or the last joint; positions alone fit"
        raise NoInitialEstimate(f"{problem}; likely: {mistake}") if mistake else problem
    likely = [wrong for wrong in errors if errors[wrong] <= ALIKE * min(errors.values())]
    wrong = min(likely, key=lambda names: (len(names), errors[names]))
    found = without[wrong]
    there = {"base": np.linalg.inv(found.base), "target": found.targets[0]}
    parts = " and ".join("[instrument]" if name == "base" else f"[{name}]" for name in wrong)
    where = " and ".join(_gap(stated[name], there[name]) for name in wrong)
    raise Mistaken(f"the description's {parts} {where}; try: omit it, so that it is estimated")


def mistake_in(arm: Arm, observations: Observations, frames: Frames | None = None) -> str | None:
    """The mistake, in words, whose correction makes the nominal arm fit the rows far better.

    None if there is none, or if balls in sockets or several targets were measured. `frames`, if
    given, explain the rows as they are.
    """
    measured = observations.measured
    if measured is None or observations.targets.any():
        return None
    # a mistake that explains whole poses is likelier than one that explains only positions
    for part in (measured, observations.positions)[: observations.kinds]:
        most = 2 if frames is None else 1  # if the rows fit already, two would be a guess
        if mistake := likely_mistake(arm, observations.joints, part, FARTHEST, most, frames):
            return mistake
    return None


def frames_of(arm: Arm, data: DataSet) -> Frames:
    """Initial estimates for a data set; with several sights, each alone must determine its frames.

    Raises Mistaken and NoInitialEstimate; with several sights, messages name the sight.
    """
    observations = replace(data.observations, optics=None)
    if data.sights is None or len(data.sights) == 1:
        return checked_frames(arm, observations, data.known)
    parts = []
    for number, name in enumerate(data.sight_names):
        rows = observations[observations.targets == number]
        try:
            parts.append(initial_frames(arm, replace(rows, targets=0 * rows.targets)))
        except NoInitialEstimate as error:
            raise NoInitialEstimate(f"{name}: {error}") from None
    frames = joined_frames(parts, data.sights)
    for number, name in enumerate(data.sight_names):
        rows = observations[observations.targets == number]
        off = median_error(frames, arm.forward(rows.joints), rows)
        if off > FARTHEST:
            raise Mistaken(
                f"{name} is {1e3 * off:.0f} mm from its place in the other pictures; expected: one"
                " place for each name; try: another name"
            )
    return data.known.stated_in(frames)


def check_distances(arm: Arm, data: DataSet, frames: Frames) -> None:
    """Raise Mistaken if a described distance between sockets is far from the nominal distance."""
    observations, names = data.observations, data.sockets
    tool = arm.forward(observations.joints)
    for one, other, length, _ in observations.distances:
        nominal = np.linalg.norm(frames.sockets[one] - frames.sockets[other])
        if abs(length - nominal) > STRETCHED * nominal + median_error(frames, tool, observations):
            raise Mistaken(
                f"the description's distance between {names[one]} and {names[other]}"
                f" is {1e3 * length:.5g} mm; in the URDF they are {1e3 * nominal:.5g} mm apart;"
                f" expected: at most {100 * STRETCHED:.0f} percent off"
            )


def _gap(given: np.ndarray, found: np.ndarray) -> str:
    """The difference of two poses (4, 4) [m] in words, and the found one as in a description."""
    gap = np.linalg.inv(given) @ found
    shift = 1e3 * np.linalg.norm(gap[:3, 3])
    angle = np.degrees(Rotation.from_matrix(gap[:3, :3]).magnitude())
    place = ", ".join(f'"{1e3 * number:.0f} mm"' for number in found[:3, 3])
    angles = Rotation.from_matrix(found[:3, :3]).as_euler("xyz", degrees=True)
    turn = ", ".join(f'"{angle:.0f} deg"' for angle in angles)
    return (
        f"is {shift:.0f} mm and {angle:.0f} deg from its estimate; expected:"
        f" about position = [{place}], roll_pitch_yaw = [{turn}]"
    )
