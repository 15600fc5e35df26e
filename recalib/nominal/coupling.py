"""Joints of one motor: those that follow another joint, as `<mimic>` in a URDF says."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from xml.etree.ElementTree import Element

import numpy as np

from recalib.errors import UnsuitableRobot
from recalib.nominal.descriptions import MOVING


@dataclass(frozen=True)
class Coupling:
    """The coordinates of all joints by those that a controller reports.

    Attributes:
        columns: names of the joints that a controller reports.
        slides: (column,) whether each is a length.
        gains: (joint, column) by which joints follow: rad or m for each rad or m.
        shifts: (joint,) rad, m where joints stand if all columns are zero.
        limits: (2, column) rad, m, lower and upper.
    """

    columns: tuple[str, ...]
    slides: np.ndarray
    gains: np.ndarray
    shifts: np.ndarray
    limits: np.ndarray

    def joints(self, columns: np.ndarray) -> np.ndarray:
        """Coordinates (n, joints) of all joints from those reported (n, columns)."""
        return columns @ self.gains.T + self.shifts

    def reported(self, joints: np.ndarray) -> np.ndarray:
        """Coordinates (n, columns) that are reported, from those of all joints (n, joints)."""
        return (joints - self.shifts) @ self._inverse.T

    @cached_property
    def _inverse(self) -> np.ndarray:
        return np.linalg.pinv(self.gains)


def coupling_of(
    joints: Mapping[str, Element], names: Sequence[str], limits: np.ndarray
) -> Coupling | None:
    """The coupling of joints by `<mimic>`; None if none follows another.

    Args:
        joints: all joints of a URDF, by name.
        names: of those between base and tool.
        limits: (2, joint) rad, m, lower and upper, of these.

    Raises UnsuitableRobot: a joint that follows itself, or none that moves.
    """
    if all(joints[name].find("mimic") is None for name in names):
        return None
    drivers, gains, shifts = zip(*(_followed(joints, name) for name in names), strict=True)
    columns = tuple(dict.fromkeys(drivers))
    matrix = np.array(
        [
            [gain * (driver == column) for column in columns]
            for driver, gain in zip(drivers, gains, strict=True)
        ]
    )
    bounds = np.array([_limits(joints[column]) for column in columns]).T
    for driver, gain, shift, ends in zip(drivers, gains, shifts, limits.T, strict=True):
        if gain:
            lower, upper = sorted((ends - shift) / gain)
            column = bounds[:, columns.index(driver)]
            column[:] = max(column[0], lower), min(column[1], upper)
    slides = np.array([joints[column].get("type") == "prismatic" for column in columns])
    return Coupling(columns, slides, matrix, np.array(shifts), bounds)


def _followed(joints: Mapping[str, Element], name: str) -> tuple[str, float, float]:
    """The joint that drives another, by which factor, and from where on."""
    gain, shift, chain = 1.0, 0.0, [name]
    while (mimic := joints[chain[-1]].find("mimic")) is not None:
        shift += gain * float(mimic.get("offset", "0"))
        gain *= float(mimic.get("multiplier", "1"))
        driver = mimic.get("joint", "")
        if driver in chain or driver not in joints or joints[driver].get("type") not in MOVING:
            raise UnsuitableRobot(
                f"{chain[-1]} follows {driver!r}; expected: another joint, which moves by itself"
            )
        chain.append(driver)
    return chain[-1], gain, shift


def _limits(joint: Element) -> tuple[float, float]:
    limit = joint.find("limit")
    if limit is None or joint.get("type") == "continuous":
        return -np.inf, np.inf
    lower, upper = (float(limit.get(end, "0")) for end in ("lower", "upper"))
    return lower, upper
