"""The exceptions of this library: attributes hold the facts, messages state the expected value."""

from collections.abc import Iterable
from numbers import Integral
from os import PathLike, fspath
from typing import Any

from recalib.spelling import instead


class RecalibError(Exception):
    """Base class of all exceptions that this library raises."""


class UnknownName(RecalibError):
    """An unknown name; the message suggests the most similar valid name."""

    def __init__(self, kind: str, name: str, valid: Iterable[str]):
        self.kind, self.name, self.valid = kind, name, sorted(valid)
        super().__init__(f"unknown {kind} {name!r}; {instead(str(name), self.valid)}")


class InvalidQuantity(RecalibError):
    """A text that is not a number with a valid unit of length or angle."""

    def __init__(self, text: object, units: Iterable[str]):
        self.text, self.units = text, sorted(units)
        super().__init__(
            f"{text!r} is not a quantity; expected: a number and one of {', '.join(self.units)},"
            f" as in '4 {self.units[0]}'"
        )


class InvalidSetting(RecalibError):
    """A setting with an invalid value; the message states the valid values."""

    def __init__(self, key: str, value: object, valid: str):
        self.key, self.value, self.valid = key, value, valid
        found = "missing" if value is None else repr(value)
        super().__init__(f"{key} is {found}; expected: {valid}")


def check_name(kind: str, name: str, valid: Iterable[str]) -> None:
    """Raise UnknownName if a name, which may be of any type, is not valid."""
    names = [*valid]
    if not isinstance(name, str) or name not in names:
        raise UnknownName(kind, name, names)


def check_kind(name: str, given: object, *kinds: type) -> None:
    """Raise InvalidSetting unless an argument is an instance of one of these classes."""
    if not isinstance(given, kinds):
        valid = " or ".join(kind.__name__ for kind in kinds)
        raise InvalidSetting(name, type(given).__name__, f"an instance of {valid}")


def check_function(name: str, given: object) -> None:
    """Raise InvalidSetting unless an argument can be called."""
    if not callable(given):
        raise InvalidSetting(name, type(given).__name__, "a function")


def check_runs(runs: object) -> None:
    """Raise InvalidSetting if the number of runs is not a positive integer."""
    if isinstance(runs, bool) or not isinstance(runs, Integral) or int(runs) < 1:
        raise InvalidSetting("runs", runs, "a whole number, at least 1")


class BadMeasurement(RecalibError):
    """An invalid measurement.

    Attributes:
        which: the name of the measurement.
        measured: the measured numbers.
        valid: a description of the expected values.
    """

    def __init__(self, which: str, measured: Iterable[float], valid: str):
        self.which, self.measured, self.valid = which, [*measured], valid
        numbers = ", ".join(f"{number:.4g}" for number in self.measured)
        super().__init__(f"{which} measured ({numbers}); expected: {valid}")


class UnsuitableRobot(RecalibError):
    """A robot that is not a serial arm with revolute or prismatic joints only."""


class Unreachable(RecalibError):
    """A pose command (4, 4) [m] that the nominal controller cannot execute.

    Attributes:
        position, rotation: (3,) m and (3, 3), the command in the base frame.
        residual: the largest component [m or rad] of the pose error at the best joint angles found.
        reason: why the command cannot be executed.
    """

    def __init__(self, pose: Any, residual: float, reason: str):
        self.position, self.rotation = pose[:3, 3].copy(), pose[:3, :3].copy()
        self.residual, self.reason = float(residual), reason
        place = ", ".join(f"{x:.3f}" for x in self.position)
        axes = "; ".join(", ".join(f"{x:.3f}" for x in row) for row in self.rotation)
        super().__init__(
            f"pose at ({place}) m, rotation [{axes}], cannot be commanded: {reason}"
            f" (residual {residual:.2g})"
        )


class InvalidFile(RecalibError):
    """A file that is damaged or has unexpected content."""

    def __init__(self, path: str | PathLike[str], reason: str):
        self.path, self.reason = fspath(path), reason
        super().__init__(f"cannot use {self.path}: {reason}")


class OtherRobot(RecalibError):
    """A file with results that were learned on another robot.

    Attributes: path, and differences: one sentence for each difference between the robots.
    """

    def __init__(self, path: str | PathLike[str], differences: Iterable[str]):
        self.path, self.differences = fspath(path), [*differences]
        super().__init__(f"{self.path} belongs to another robot: {'; '.join(self.differences)}")


class UnfitWorkspace(RecalibError):
    """A workspace that the nominal robot cannot reach everywhere."""
