"""Interfaces between the parts: an object that implements one can replace the shipped one.

Commands and achieved poses are coordinates of the workspace (`recalib.nominal.poses`). The first
axis is always the run: an experiment trains many runs side by side.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol, Self, runtime_checkable

import numpy as np

if TYPE_CHECKING:
    from recalib.nominal.poses import Workspace
    from recalib.nominal.robots import Robot


class Outcome(NamedTuple):
    """What came of commanded moves, axes (run, move).

    Attributes:
        achieved: (run, move, 6) coordinates of the achieved poses; a refused move leaves the arm
            at home.
        executed: (run, move) whether the command was carried out.
    """

    achieved: np.ndarray
    executed: np.ndarray


Execute = Callable[[np.ndarray], Outcome]


class Learner(Protocol):
    """Given a desired pose, what to command; given what happened, what to learn.

    Nothing but pose commands and measured poses pass between it and a robot.
    """

    def command(self, desired: np.ndarray) -> np.ndarray:
        """Pose commands (run, pose, 6) for the desired poses (run, pose, 6)."""

    def learn(self, desired: np.ndarray, execute: Execute, fraction: float) -> None:
        """One iteration: try the desired poses (run, 6) by moves through `execute`; learn from it.

        Args:
            fraction: of the training that is done, in [0, 1).
        """


# What one run has learned: arrays by name, in groups where that is clearer. What is None or absent
# has not been learned yet.
State = Mapping[str, Any]


class Savable(Learner, Protocol):
    """A learner that `recalib.learners.learned` can save.

    Its class is named in `recalib.learners.kinds`.
    """

    @classmethod
    def from_settings(cls, settings: Mapping[str, Any], runs: int, robot: "Robot") -> Self:
        """The learner of so many runs that has learned nothing, from what `settings` returned."""

    def settings(self) -> dict[str, Any]:
        """What it was made with, in the types of JSON; a list, `by_run`, of what runs differ in."""

    def state(self) -> list[State]:
        """What each run has learned: enough to go on from there, whatever is learned later."""

    def restore(self, states: Sequence[State]) -> None:
        """Take over what `state` returned, in a learner made with the same settings."""


class Commandable(Protocol):
    """What an experiment asks of its robots, one for each run: to take pose commands."""

    @property
    def workspace(self) -> "Workspace":
        """The workspace in whose coordinates poses are given."""

    @property
    def moves(self) -> int:
        """How many moves were commanded in each run."""

    @property
    def refused(self) -> np.ndarray | int:
        """(run,) how many of them were not carried out; 0 before the first."""

    def execute(self, commands: np.ndarray) -> Outcome:
        """Command poses, coordinates (run, move, 6), and measure what is achieved."""

    def achieve(self, commands: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Achieved poses (run, move, 4, 4) [m] and whether each was executed (run, move).

        As `execute`, to judge a learner by: these moves are not counted and, where the robot is
        simulated, free of disturbances.
        """


@runtime_checkable
class ForwardKinematics(Protocol):
    """What a simulated robot asks of its arm: where it takes the tool."""

    def forward(self, angles: np.ndarray) -> np.ndarray:
        """Poses (n, 4, 4) of the tool in the base frame [m].

        Args:
            angles: (n, joint) rad that the controller assumes.
        """
