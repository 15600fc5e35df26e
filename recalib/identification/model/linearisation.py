"""Residuals of observations, linearised in the parameters.

A residual is what takes the predicted pose to the measured one: translation [m] and rotation [rad]
along the instrument's axes, or the translation alone where no orientation was measured; a ball in a
socket was measured to be at the socket's centre, which is a parameter itself. What a camera
measured is weighed by its optics.
"""

from collections.abc import Iterator
from functools import cached_property

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.identification.model.error_model import ErrorModel
from recalib.identification.model.observations import Observations

LEVER = 0.5  # m: what a turn of one rad counts as, where both are one number
BLOCK = 1000  # rows at once: more would take memory, and no less time


def displacements(start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """What takes poses (n, 4, 4) to others: (n, 6) [m, rad] along and about their frame's axes.

    What takes them to positions (n, 3): the translations (n, 3) alone.
    """
    if end.ndim == 2:
        return end - start[:, :3, 3]
    between = end[:, :3, :3] @ start[:, :3, :3].swapaxes(1, 2)
    turns = Rotation.from_matrix(between, assume_valid=True).as_rotvec()
    return np.concatenate([end[:, :3, 3] - start[:, :3, 3], turns], axis=-1)


def displaced(pose: np.ndarray, step: np.ndarray) -> np.ndarray:
    """A pose (4, 4) [m] after a displacement (6,) [m, rad] along and about its frame's axes."""
    moved = pose.copy()
    moved[:3, 3] += step[:3]
    moved[:3, :3] = Rotation.from_rotvec(step[3:]).as_matrix() @ pose[:3, :3]
    return moved


class Linearisation:
    """Residuals and their slopes by the parameters over their deviations.

    Args:
        parameters: (P,) over their deviations, where to linearise.
        terms: (n, term, joints) of the observations, for speed: they depend on no parameter.

    Attributes:
        residuals: (kind, n, 3) m, rad; `move` keeps them up to date.
        jacobians: (kind, n, 3, P) of the predictions.
        reach: (P,) how far [m, rad] each parameter moves the most movable target.
    """

    def __init__(
        self,
        model: ErrorModel,
        parameters: np.ndarray,
        observations: Observations,
        terms: np.ndarray | None = None,
    ):
        self._origin = parameters
        self.residuals = np.empty((observations.kinds, len(observations), 3))
        self.jacobians = np.empty((*self.residuals.shape, len(parameters)))
        parameters = parameters * model.deviations
        for first in range(0, len(observations), BLOCK):
            block = slice(first, first + BLOCK)
            batch = observations[block]
            own = None if terms is None else terms[block]
            poses, jacobians = model.linearise(parameters, batch.joints, batch.targets, own)
            if batch.measured is None:
                # where the centre goes, the residual goes: the other way than with the prediction
                by_centre = jacobians[:, :3, model.socket_columns].reshape(len(batch), 3, -1, 3)
                by_centre[np.arange(len(batch)), :, batch.sockets] = -np.eye(3)
                jacobians[:, :3, model.socket_columns] = by_centre.reshape(len(batch), 3, -1)
            residuals = displacements(poses, batch.reached(model.sockets(parameters)))
            if batch.optics is not None:  # measured poses move with them: the other way
                columns = model.optics_columns
                residuals += batch.optics.slopes @ parameters[columns]
                jacobians = jacobians[:, : residuals.shape[1]]
                jacobians[:, :, columns] = -batch.optics.slopes
                residuals, jacobians = batch.whitened(residuals), batch.whitened(jacobians)
            for kind in range(observations.kinds):
                part = slice(3 * kind, 3 * kind + 3)
                self.residuals[kind, block] = residuals[:, part]
                np.multiply(jacobians[:, part], model.deviations, out=self.jacobians[kind, block])
        highest, lowest = (f(self.jacobians, axis=(0, 1, 2)) for f in (np.max, np.min))
        self.reach = np.maximum(highest, -lowest)

    def is_good_at(self, parameters: np.ndarray, negligible: float) -> bool:
        """Whether no parameter alone has moved a target by more than the root of `negligible`."""
        return bool(np.max(np.abs(parameters - self._origin) * self.reach) ** 2 <= negligible)

    def move(self, step: np.ndarray) -> None:
        """Move the parameters by a step (P,), over their deviations."""
        rows = self.jacobians.reshape(-1, len(step))
        self.residuals = self.residuals - (rows @ step).reshape(self.residuals.shape)

    def normal_equations(self, weights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """J' W J (kind, P, P) and J' W r (kind, P), with weights (n,) up to 1 of the rows."""
        information, doubted = self._information, np.flatnonzero(weights < 1)
        if len(doubted):  # they are few: take off their surplus
            information = information.copy()
            for kind, rows in self._scaled(doubted, np.sqrt(1 - weights[doubted])):
                information[kind] -= rows.T @ rows
        weighted = (self.residuals * weights[:, None]).reshape(len(self.residuals), -1)
        rows = self.jacobians.reshape(*weighted.shape, -1)
        return information, np.einsum("kr,krp->kp", weighted, rows, optimize=True)

    @cached_property
    def _information(self) -> np.ndarray:
        """J' J (kind, P, P)."""
        kinds, count, _, size = self.jacobians.shape
        information = np.zeros((kinds, size, size))
        for kind, rows in self._scaled(np.arange(count), np.ones(count)):
            information[kind] += rows.T @ rows
        return information

    def _scaled(self, rows: np.ndarray, factors: np.ndarray) -> Iterator[tuple[int, np.ndarray]]:
        """Kinds, each with Jacobians (row, P) of some rows times their factors, in blocks."""
        for first in range(0, len(rows), BLOCK):
            block, by = rows[first : first + BLOCK], factors[first : first + BLOCK, None, None]
            for kind, jacobians in enumerate(self.jacobians):
                yield kind, (jacobians[block] * by).reshape(-1, jacobians.shape[-1])
