"""Measurements of an arm at the joint coordinates that its controller reported.

A set of observations has rows of one of three kinds: the pose of a target on the tool, in the frame
of the instrument; its position; or a ball on the tool that sits in a fixed socket at an unknown
position, which needs no instrument. Rows that cannot be measurements are refused.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from recalib.arrays import are_poses
from recalib.errors import BadMeasurement, InvalidSetting, check_kind
from recalib.identification.model.frames import Frames
from recalib.identification.model.optics import Optics
from recalib.loop.external import FARTHEST, POSE, SKEW

TURNED = 4 * np.pi  # rad: larger joint angles are impossible, or not in radians


class Distance(NamedTuple):
    """A distance between two sockets, by their numbers, and its standard deviation [m]."""

    one: int
    other: int
    length: float
    deviation: float = 5e-5


@dataclass(frozen=True)
class Observations:
    """Measurements of an arm.

    Attributes:
        joints: (n, joints) rad, or m for prismatic joints, as the controller reported them.
        measured: poses (n, 4, 4) or positions (n, 3) [m] of a target in the instrument's frame;
            None for a ball in sockets.
        targets: (n,) the number of the target or ball (of the sight if there are several
            instruments: see `Frames`); default: 0.
        sockets: (n,) the number of the ball's socket; None if an instrument measured.
        distances: known distances between sockets.
        times: (n,) s, in ascending order; None if none were recorded.
        optics: the information of poses from cameras; None if all rows have equal weight.

    Raises InvalidSetting: joints are no array, or another array has a different number of rows.
    """

    joints: np.ndarray
    measured: np.ndarray | None = None
    targets: np.ndarray = None  # type: ignore[assignment]  # __post_init__ puts zeros there
    sockets: np.ndarray | None = None
    distances: Sequence[Distance] = field(default=())
    times: np.ndarray | None = None
    optics: Optics | None = None

    def __post_init__(self) -> None:
        check_kind("joints", self.joints, np.ndarray)
        for name in ("measured", "targets", "sockets", "times"):
            values, count = getattr(self, name), len(self.joints)
            if values is not None and np.shape(values)[:1] != (count,):
                valid = f"an array of {count} rows, as joints has"
                raise InvalidSetting(name, f"of shape {np.shape(values)}", valid)
        if self.targets is None:
            object.__setattr__(self, "targets", np.zeros(len(self.joints), dtype=int))

    def __len__(self) -> int:
        return len(self.joints)

    def __getitem__(self, rows: np.ndarray | slice) -> "Observations":
        """The observations in some rows, given by number, by a mask or by a slice."""
        by_row = vars(self) | {"distances": None}
        some = {name: values[rows] for name, values in by_row.items() if values is not None}
        return replace(self, **some)

    def with_noise(self, covariance: np.ndarray) -> "Observations":
        """The same observations by cameras, with a covariance (6, 6) added to their noise."""
        assert self.optics is not None
        return replace(self, optics=self.optics.with_noise(covariance))

    def whitened(self, columns: np.ndarray) -> np.ndarray:
        """Displacements (n, 6, ...) of poses, whitened by their optics if there are any."""
        if self.optics is None:
            return columns
        return np.einsum("nij,nj...->ni...", self.optics.whitening, columns)

    @property
    def positions(self) -> np.ndarray:
        """Measured positions (n, 3) [m]; undefined for balls in sockets."""
        assert self.measured is not None
        return self.measured if self.kinds == 1 else self.measured[:, :3, 3]

    @property
    def rotations(self) -> np.ndarray:
        """Measured orientations (n, 3, 3); only if `kinds` is 2."""
        assert self.measured is not None
        return self.measured[:, :3, :3]

    def reached(self, sockets: np.ndarray) -> np.ndarray:
        """The targets' `measured` poses or positions; for balls, their sockets' centres [m]."""
        return sockets[self.sockets] if self.measured is None else self.measured

    @property
    def kinds(self) -> int:
        """The number of quantities in a row: 2 for position and orientation, 1 for position."""
        return 2 if self.measured is not None and self.measured.ndim == 3 else 1

    @property
    def series(self) -> np.ndarray:
        """The number (n,) of each row's series: its rows are in the order of measurement.

        The pictures of each board by each camera are one series; so are all other rows together.
        """
        return 0 * self.targets if self.optics is None else self.targets

    @property
    def groups(self) -> np.ndarray:
        """The number (n,) of each row's group: a target, or a ball in a socket."""
        labels = self.targets if self.sockets is None else np.stack([self.targets, self.sockets])
        return np.unique(labels, return_inverse=True, axis=-1)[1]


def check_observations(observations: Observations, slides: np.ndarray, frames: Frames) -> None:
    """Raise BadMeasurement if rows do not fit the frames or the arm's joints, prismatic or not."""
    count = len(observations)
    if count == 0:
        raise BadMeasurement("the number of observations", [0], "one or more")
    sizes: dict[str, list[tuple[int, ...]]] = {
        "joints": [(count, len(slides))],
        "targets": [(count,)],
    }
    if observations.measured is None:
        sizes["sockets"] = [(count,)]
    else:
        sizes["measured"] = [(count, 3), (count, 4, 4)]
    for name, fit in sizes.items():
        size = np.shape(getattr(observations, name))
        if size not in fit:
            valid = " or ".join(map(str, fit))
            raise BadMeasurement(f"the size of the observations' {name!r}", size, valid)
    tables = [
        ("joint angles of measurement", observations.joints[:, ~slides], TURNED, "rad"),
        ("joint positions of measurement", observations.joints[:, slides], FARTHEST, "m"),
    ]
    if observations.measured is not None:
        tables.append(("measurement", observations.measured, FARTHEST, "m in the base frame"))
    for what, values, most, unit in tables:
        valid = f"numbers up to {most:.3g} ({unit})"
        _check_each(what, values, np.abs(values) <= most, valid)
    check_rows(observations)
    for what, numbers, end in (
        ("target of measurement", observations.targets, len(frames.sights)),
        ("socket of measurement", observations.sockets, len(frames.sockets)),
    ):
        if numbers is not None:
            _check_each(what, numbers, np.isin(numbers, np.arange(end)), f"below {end}")


def check_rows(observations: Observations) -> None:
    """Raise BadMeasurement unless all numbers are finite, and all measured matrices are poses."""
    joints, measured = observations.joints, observations.measured
    _check_each("joint angles of measurement", joints, np.isfinite(joints), "numbers")
    if measured is not None:
        _check_each("measurement", measured, np.isfinite(measured), "numbers")
        if observations.kinds == 2:
            _check_each("measurement", measured, are_poses(measured, SKEW), POSE)


def _check_each(what: str, values: np.ndarray, good: np.ndarray, valid: str) -> None:
    """Raise BadMeasurement for the first row (n, ...) with an element that is not good."""
    rows = good.reshape(len(good), -1).all(axis=1)
    if not rows.all():
        row = rows.argmin()
        raise BadMeasurement(f"{what} {row}", np.ravel(values[row]), valid)
