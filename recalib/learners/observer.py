"""Base classes of learners that make one move an iteration and learn from every measured move."""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from typing import Any, ClassVar, Self

import numpy as np

from recalib.arrays import ending
from recalib.errors import check_function, check_runs
from recalib.loop.interfaces import Execute, State
from recalib.loop.moves import Moves, check_moves
from recalib.nominal.robots import Robot

PLACES = 3  # leading binary digits of the number of moves; refit when they change


class Observer(ABC):
    """A learner that can learn from any move, also from moves that it did not choose."""

    _last: Moves | None = None  # the previous move, for checks of the next

    @abstractmethod
    def command(self, desired: np.ndarray) -> np.ndarray:
        """Pose commands (run, pose, 6) for the desired poses (run, pose, 6)."""

    def observe(self, commands: np.ndarray, achieved: np.ndarray, executed: np.ndarray) -> None:
        """Learn from moves, except from refused ones.

        Args:
            commands: (run, move, 6) the pose commands that were sent.
            achieved: (run, move, 6) the poses that were reached.
            executed: (run, move) whether the command was carried out.

        Raises BadMeasurement, and learns nothing, if the achieved pose is not a number, far off, or
        the same for all commands.
        """
        self._last = check_moves(commands, achieved, executed, self._last)
        self._update(commands, achieved, executed)

    @abstractmethod
    def _update(self, commands: np.ndarray, achieved: np.ndarray, executed: np.ndarray) -> None:
        """Learn from moves that have passed the checks; see `observe`."""

    def learn(self, desired: np.ndarray, execute: Execute, fraction: float) -> None:
        """Make one move to the desired poses (run, 6), and learn from it."""
        check_function("execute", execute)
        commands = self.command(ending("desired", desired, 6)[:, None])
        outcome = execute(commands)
        self.observe(commands, outcome.achieved, outcome.executed)


def is_due(before: int, moves: int) -> bool:
    """Whether to refit a model to all moves, after their number has risen from `before` to `moves`.

    A refit is due after every move up to 8, every second up to 16, every fourth up to 32, and so
    on. So at most a fifth of the moves are not yet in a model, and hundreds of moves take little
    more time than dozens.
    """
    stride = 2 ** max(moves.bit_length() - PLACES, 0)
    return moves // stride > before // stride


class Refitting(Observer):
    """A learner with a model for each run, refitted to all moves of the run from time to time.

    Args:
        runs: number of independent trainings.
        sent: length of the stored vector of a command.

    Attributes:
        models: one for each run; None before anything has been learned.
        moves: the number of moves in each run, including refused ones.

    Raises InvalidSetting for an invalid number of runs.
    """

    MODEL: ClassVar[str]  # key of the model in files

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
            for run, (last, moves) in enumerate(zip(self.models, self._by_run(), strict=True)):
                sent, achieved, executed = moves.values()
                if executed.any():
                    self.models[run] = self._fit(sent[executed], achieved[executed], last, before)

    def _by_run(self) -> list[dict[str, np.ndarray]]:
        runs = range(len(self.models))
        return [{name: values[run] for name, values in self._moves.items()} for run in runs]

    def _sent(self, commands: np.ndarray) -> np.ndarray:
        """The vectors (run, move, sent) to store for pose commands (run, move, 6)."""
        return commands

    @abstractmethod
    def _fit(self, sent: np.ndarray, achieved: np.ndarray, last: Any, before: int) -> Any:
        """The model of a run.

        Args:
            sent, achieved: (n, sent) and (n, 6) the executed moves of the run.
            last: the previous model; None if there is none.
            before: the number of moves before the latest ones.
        """

    @abstractmethod
    def _restored(self, state: Mapping[str, Any]) -> Any:
        """The model that had this state."""

    @classmethod
    def from_settings(cls, settings: Mapping[str, Any], runs: int, robot: Robot) -> Self:
        """An untrained learner for a number of runs; it has no settings."""
        return cls(runs=runs)

    def settings(self) -> dict[str, Any]:
        """No settings."""
        return {}

    def state(self) -> list[State]:
        """For each run, its moves and its model, if there is one yet."""
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
