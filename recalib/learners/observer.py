"""What today's learners share: one move an iteration, and learning from every measured move."""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from typing import Any, ClassVar, Self

import numpy as np

from recalib.arrays import ending
from recalib.errors import check_runs
from recalib.loop.interfaces import Execute, State
from recalib.loop.moves import Moves, check_moves
from recalib.nominal.robots import Robot

PLACES = 3  # binary digits of the numbers of moves after which to learn anew


class Observer(ABC):
    """A learner that learns from any move, whoever chose it."""

    _last: Moves | None = None  # the move with which the next is compared

    @abstractmethod
    def command(self, desired: np.ndarray) -> np.ndarray:
        """Pose commands (run, pose, 6) for the desired poses (run, pose, 6)."""

    def observe(self, commands: np.ndarray, achieved: np.ndarray, executed: np.ndarray) -> None:
        """Learn from moves; nothing is learned from those that were refused.

        Args:
            commands: (run, move, 6) the pose commands that were sent.
            achieved: (run, move, 6) the poses that were reached.
            executed: (run, move) whether the command was carried out.

        Raises BadMeasurement if the achieved pose is not a number, far off, or the same for all
        commands; then nothing is learned.
        """
        self._last = check_moves(commands, achieved, executed, self._last)
        self._update(commands, achieved, executed)

    @abstractmethod
    def _update(self, commands: np.ndarray, achieved: np.ndarray, executed: np.ndarray) -> None:
        """Learn from moves that are sound; see `observe`."""

    def learn(self, desired: np.ndarray, execute: Execute, fraction: float) -> None:
        """One move to the desired poses (run, 6)."""
        commands = self.command(ending("desired", desired, 6)[:, None])
        outcome = execute(commands)
        self.observe(commands, outcome.achieved, outcome.executed)


def is_due(before: int, moves: int) -> bool:
    """Whether to learn anew from everything, now that there are so many moves and not `before`.

    That is after every move up to 8, every second up to 16, every fourth up to 32, and so on:
    a model lacks at most a fifth of the known moves, and hundreds of moves take little more time
    than dozens.
    """
    stride = 2 ** max(moves.bit_length() - PLACES, 0)
    return moves // stride > before // stride


class Refitting(Observer):
    """A learner with a model for each run, fitted anew now and then to all of the run's moves.

    Args:
        runs: how many independent trainings.
        sent: how many numbers of a command are kept.

    Attributes:
        models: of each run; None where nothing has been learned.
        moves: how many there were, refused ones included.

    Raises InvalidSetting: no number of runs.
    """

    MODEL: ClassVar[str]  # what a model is called in files

    def __init__(self, *, runs: int = 1, sent: int = 6):
        check_runs(runs)
        self._moves = {
            "sent": np.empty((runs, 0, sent)),
            "achieved": np.empty((runs, 0, 6)),
            "executed": np.empty((runs, 0), dtype=bool),
        }
        self.models: list[Any] = [None] * runs

    @property
    def moves(self) -> int:
        return self._moves["executed"].shape[1]

    def _update(self, commands: np.ndarray, achieved: np.ndarray, executed: np.ndarray) -> None:
        before = self.moves
        new = self._sent(commands), achieved, executed
        for name, values in zip(self._moves, new, strict=True):
            self._moves[name] = np.concatenate([self._moves[name], values], axis=1)
        if is_due(before, self.moves):
            for run, (last, kept) in enumerate(zip(self.models, self._by_run(), strict=True)):
                sent, achieved, executed = kept.values()
                if executed.any():
                    self.models[run] = self._fit(sent[executed], achieved[executed], last, before)

    def _by_run(self) -> list[dict[str, np.ndarray]]:
        runs = range(len(self.models))
        return [{name: values[run] for name, values in self._moves.items()} for run in runs]

    def _sent(self, commands: np.ndarray) -> np.ndarray:
        """What is kept (run, move, sent) of pose commands (run, move, 6)."""
        return commands

    @abstractmethod
    def _fit(self, sent: np.ndarray, achieved: np.ndarray, last: Any, before: int) -> Any:
        """The model of a run.

        Args:
            sent, achieved: (n, sent) and (n, 6) of its executed moves.
            last: the model so far, if there is one.
            before: how many moves it may have been fitted to.
        """

    @abstractmethod
    def _restored(self, state: Mapping[str, Any]) -> Any:
        """The model with this state."""

    @classmethod
    def from_settings(cls, settings: Mapping[str, Any], runs: int, robot: Robot) -> Self:
        """An untrained learner for a number of runs; it has no settings."""
        return cls(runs=runs)

    def settings(self) -> dict[str, Any]:
        """It has none."""
        return {}

    def state(self) -> list[State]:
        """For each run its moves and, once there is one, its model."""
        return [
            {"moves": moves, self.MODEL: model and model.state()}
            for moves, model in zip(self._by_run(), self.models, strict=True)
        ]

    def restore(self, states: Sequence[State]) -> None:
        self._moves = {
            name: np.stack([state["moves"][name] for state in states]) for name in self._moves
        }
        self.models = [
            self._restored(state[self.MODEL]) if state.get(self.MODEL) else None for state in states
        ]
