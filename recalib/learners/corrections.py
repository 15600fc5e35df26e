"""Black-box learners: they correct the command, without a model of the arm.

The correction, command minus achieved pose, is a function of the achieved coordinates. To reach a
desired pose, a learner commands this pose plus its correction.
"""

import math
from collections.abc import Mapping, Sequence
from typing import Any, Self

import numpy as np

from recalib.arrays import array_of
from recalib.errors import InvalidSetting, check_kind, check_runs
from recalib.learners.observer import Observer, Refitting
from recalib.loop.interfaces import State
from recalib.nominal.robots import Robot
from recalib.numerics.monomials import monomials
from recalib.numerics.regression import Process, is_time_to_search

# Prior standard deviations of the coefficients by degree, and of the residual, in workspace
# coordinates. Errors of some centimetres and degrees, an arm's length away, make smaller
# coefficients at each higher degree.
DEVIATIONS = 0.3, 0.1, 0.03
NOISE = 3e-3


class PolynomialLearner(Observer):
    """Affine and quadratic corrections, by regularised recursive least squares.

    The prior mean is the intact robot: no correction.

    Args:
        degree: 1 for affine, 2 for quadratic.
        runs: number of independent trainings.

    Raises InvalidSetting for any other degree, and for an invalid number of runs.
    """

    def __init__(self, degree: int, *, runs: int = 1):
        check_kind("degree of a polynomial learner", degree, int)
        if degree not in (1, 2):
            raise InvalidSetting("degree of a polynomial learner", degree, "1 or 2")
        check_runs(runs)
        self._degree = degree
        degrees = np.repeat(
            range(degree + 1), [math.comb(5 + power, power) for power in range(degree + 1)]
        )
        self._coefficients = np.zeros((runs, len(degrees), 6))
        # posterior covariance of the coefficients, divided by the variance of the noise
        self._spread = np.tile(np.diag((np.array(DEVIATIONS)[degrees] / NOISE) ** 2), (runs, 1, 1))

    def command(self, desired: np.ndarray) -> np.ndarray:
        desired = array_of("desired", desired, (len(self._coefficients), "n", 6))
        return desired + monomials(desired, self._degree) @ self._coefficients

    def _update(self, commands: np.ndarray, achieved: np.ndarray, executed: np.ndarray) -> None:
        """Learn from moves, one after the other."""
        for move in range(executed.shape[1]):
            features = monomials(achieved[:, [move]], self._degree)
            reach = features @ self._spread  # (run, 1, F)
            valid = executed[:, [move], None]
            gain = reach / (1 + reach @ features.swapaxes(1, 2)) * valid
            residuals = (commands - achieved)[:, [move]] - features @ self._coefficients
            residuals = np.where(valid, residuals, 0)  # of a refused move, it may be nan
            self._coefficients += gain.swapaxes(1, 2) @ residuals
            self._spread -= gain.swapaxes(1, 2) @ reach

    @classmethod
    def from_settings(cls, settings: Mapping[str, Any], runs: int, robot: Robot) -> Self:
        return cls(**settings, runs=runs)

    def settings(self) -> dict[str, Any]:
        """The degree."""
        return {"degree": self._degree}

    def state(self) -> list[State]:
        """For each run the coefficients (F, 6) and their spread (F, F)."""
        return [
            {"coefficients": coefficients.copy(), "spread": spread.copy()}
            for coefficients, spread in zip(self._coefficients, self._spread, strict=True)
        ]

    def restore(self, states: Sequence[State]) -> None:
        self._coefficients = np.stack([state["coefficients"] for state in states])
        self._spread = np.stack([state["spread"] for state in states])


class GaussianProcessLearner(Refitting):
    """The correction as a Gaussian process of the achieved pose.

    Hyperparameters are optimised again each time the number of moves passes a power of two, up to
    `regression.MOST` moves.
    """

    MODEL = "process"

    def command(self, desired: np.ndarray) -> np.ndarray:
        desired = array_of("desired", desired, (len(self.models), "n", 6))
        return np.stack(
            [
                poses if process is None else poses + process.predict(poses)
                for poses, process in zip(desired, self.models, strict=True)
            ]
        )

    def _fit(
        self, sent: np.ndarray, achieved: np.ndarray, last: Process | None, before: int
    ) -> Process:
        if last is None or is_time_to_search(before, self.moves):
            return Process(achieved, sent - achieved)
        return Process(achieved, sent - achieved, last.hyperparameters)

    def _restored(self, state: Mapping[str, Any]) -> Process:
        return Process(**state)
