"""Learners that refit: they keep every executed move, and learn from all of them now and then."""

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from typing import Any, ClassVar

import numpy as np

from recalib.learners.observer import Observer
from recalib.loop.interfaces import State

PLACES = 3  # binary digits of the numbers of moves after which to learn anew


def is_due(before: int, moves: int) -> bool:
    """Whether to learn anew from everything, now that there are so many moves and not `before`.

    That is after every move up to 8, every second up to 16, every fourth up to 32, and so on:
    what is learned from lacks at most a fifth of what is known, and hundreds of moves take little
    more time than dozens.
    """
    stride = 2 ** max(moves.bit_length() - PLACES, 0)
    return moves // stride > before // stride


class Experience:
    """The moves of each run: what was sent, and what was achieved.

    Args:
        runs: how many.
        sent: how many numbers are sent in a move.

    Attributes:
        moves: how many there were, refused ones included.
    """

    def __init__(self, runs: int, sent: int = 6):
        self._sent, self._achieved = np.empty((runs, 0, sent)), np.empty((runs, 0, 6))
        self._executed = np.empty((runs, 0), dtype=bool)

    @property
    def moves(self) -> int:
        return self._executed.shape[1]

    def add(self, sent: np.ndarray, achieved: np.ndarray, executed: np.ndarray) -> None:
        """Keep moves.

        Args:
            sent: (run, move, sent) in the form that the learner uses.
            achieved: (run, move, 6) in coordinates of the workspace.
            executed: (run, move) whether they were carried out.
        """
        self._sent = np.concatenate([self._sent, sent], axis=1)
        self._achieved = np.concatenate([self._achieved, achieved], axis=1)
        self._executed = np.concatenate([self._executed, executed], axis=1)

    def of(self, run: int) -> tuple[np.ndarray, np.ndarray]:
        """Sent (n, sent) and achieved (n, 6) of the moves that one run carried out."""
        executed = self._executed[run]
        return self._sent[run, executed], self._achieved[run, executed]

    def state(self) -> list[State]:
        """The moves of each run."""
        parts = zip(self._sent, self._achieved, self._executed, strict=True)
        return [
            dict(zip(("sent", "achieved", "executed"), arrays, strict=True)) for arrays in parts
        ]

    def restore(self, states: Sequence[State]) -> None:
        """Take over what `state` returned."""
        self._sent, self._achieved, self._executed = (
            np.stack([state[name] for state in states]) for name in ("sent", "achieved", "executed")
        )


class Refitting(Observer):
    """A learner with a model for each run, fitted to all of the run's moves.

    Args:
        runs: how many independent trainings.
        sent: how many numbers are kept of what is sent in a move.

    Attributes:
        models: of each run; None where nothing has been learned.
    """

    MODEL: ClassVar[str]  # what a model is called in files

    def __init__(self, runs: int, sent: int = 6):
        self._experience = Experience(runs, sent)
        self.models: list[Any] = [None] * runs

    def _update(self, commands: np.ndarray, achieved: np.ndarray, executed: np.ndarray) -> None:
        before = self._experience.moves
        self._experience.add(self._sent(commands), achieved, executed)
        if is_due(before, self._experience.moves):
            for run, last in enumerate(self.models):
                moves = self._experience.of(run)
                if len(moves[0]):
                    self.models[run] = self._fit(*moves, last, before)

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

    def settings(self) -> dict[str, Any]:
        """It has none."""
        return {}

    def state(self) -> list[State]:
        """For each run its moves and, once there is one, its model."""
        return [
            {"moves": moves, self.MODEL: model and model.state()}
            for moves, model in zip(self._experience.state(), self.models, strict=True)
        ]

    def restore(self, states: Sequence[State]) -> None:
        """Take over what `state` returned."""
        self._experience.restore([state["moves"] for state in states])
        self.models = [
            self._restored(state[self.MODEL]) if state.get(self.MODEL) else None for state in states
        ]
