"""Interfaces of robots and learners: any object that implements one can be used.

Commands and achieved poses are coordinates of a workspace (`recalib.nominal.workspace`). The first
axis is always the run, because an experiment trains many runs side by side.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple, Protocol, Self, runtime_checkable

import numpy as np

from recalib.nominal.robots import Robot
from recalib.nominal.workspace import Workspace


class Outcome(NamedTuple):
    """The outcome of commanded moves, axes (run, move).

    Attributes:
        achieved: (run, move, 6) coordinates of the achieved poses; after a refused move the arm is
            at home.
        executed: (run, move) whether each command was executed.
    """

    achieved: np.ndarray
    executed: np.ndarray


Execute = Callable[[np.ndarray], Outcome]


@runtime_checkable
class Learner(Protocol):
    """The interface of a learner: it commands desired poses and learns from the outcomes.

    A learner and a robot exchange only pose commands and measured poses.
    """

    def command(self, desired: np.ndarray) -> np.ndarray:
        """Pose commands (run, pose, 6) for the desired poses (run, pose, 6)."""

    def learn(self, desired: np.ndarray, execute: Execute, fraction: float) -> None:
        """One iteration: command desired poses (run, 6) by `execute`, and learn from the outcome.

        Args:
            fraction: part of the training that is done, in [0, 1).
        """


# The learned state of one run: arrays by name, or groups of arrays. An array that has not been
# learned yet is None or absent.
State = Mapping[str, Any]


class Savable(Learner, Protocol):
    """A learner that `recalib.learners.learned` can save.

    Its class is named in `recalib.learners.kinds`.
    """

    @classmethod
    def from_settings(cls, settings: Mapping[str, Any], runs: int, robot: Robot) -> Self:
        """An untrained learner for a number of runs, from the `settings` of another."""

    def settings(self) -> dict[str, Any]:
        """Settings, in the types of JSON; `by_run` lists settings that differ between runs."""

    def state(self) -> list[State]:
        """The learned state of each run, sufficient for further training."""

    def restore(self, states: Sequence[State]) -> None:
        """Set the state to the `state` of a learner with the same settings."""


@runtime_checkable
class Commandable(Protocol):
    """The interface of an experiment's robots, one for each run: they execute pose commands."""

    @property
    def workspace(self) -> Workspace:
        """The workspace in whose coordinates poses are given."""

    @property
    def moves(self) -> int:
        """The number of moves commanded in each run."""

    @property
    def refused(self) -> np.ndarray | int:
        """The number (run,) of moves that were not executed; 0 before the first move."""

    def execute(self, commands: np.ndarray) -> Outcome:
        """Command poses, coordinates (run, move, 6), and measure the achieved poses."""

    def achieve(self, commands: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Achieved poses (run, move, 4, 4) [m] and whether each was executed (run, move).

        Use it to evaluate a learner: unlike moves by `execute`, these moves are not counted and, if
        the robot is simulated, have no random errors.
        """


@runtime_checkable
class ForwardKinematics(Protocol):
    """The interface of a simulated robot's arm: its forward kinematics."""

    def forward(self, angles: np.ndarray) -> np.ndarray:
        """Tool poses (n, 4, 4) [m] in the base frame, at joint angles (n, joint) [rad]."""
