"""Residuals of observations, linearised in the parameters.

A residual is the displacement from the predicted pose to the measured one: translation [m] and
rotation [rad] along the instrument's axes, or the translation alone if no orientation was measured.
The measured position of a ball is the centre of its socket, which is a parameter itself. Poses from
cameras are weighted by their optics.
"""

from collections.abc import Iterator
from functools import cached_property

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.identification.model.error_model import ErrorModel
from recalib.identification.model.observations import Observations

LEVER = 0.5  # m: the length that a turn of one rad counts as in sums of lengths and turns
CROSSES = np.cross(np.eye(3)[:, None], np.eye(3)).swapaxes(1, 2)  # of each axis
BLOCK = 1000  # rows at once: more would take more memory, but no less time


def displacements(start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Displacements (n, 6) [m, rad] from poses to poses (n, 4, 4), along their frame's axes.

    If the end is positions (n, 3), the translations (n, 3) alone.
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


def crosses(vectors: np.ndarray) -> np.ndarray:
    """Skew-symmetric matrices (n, 3, 3) of the cross products with vectors (n, 3) on the left."""
    return (vectors @ CROSSES.reshape(3, 9)).reshape(-1, 3, 3)


class Linearisation:
    """Residuals, and the predictions' slopes by the parameters over their deviations.

    Args:
        parameters: (P,) over their deviations, at which to linearise.
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
            in_block = None if terms is None else terms[block]
            poses, jacobians = model.linearise(parameters, batch.joints, batch.targets, in_block)
            if batch.measured is None:
                # the centre is the measurement, so its sign is opposite to that of a prediction
                by_centre = jacobians[:, :3, model.socket_columns].reshape(len(batch), 3, -1, 3)
                by_centre[np.arange(len(batch)), :, batch.sockets] = -np.eye(3)
                jacobians[:, :3, model.socket_columns] = by_centre.reshape(len(batch), 3, -1)
            residuals = displacements(poses, batch.reached(model.sockets(parameters)))
            if batch.optics is not None:  # they move the measured poses: the sign is opposite, too
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
        if len(doubted):  # they are few, so subtract their excess weight
            information = information.copy()
            for kind, rows in self._scaled(doubted, np.sqrt(1 - weights[doubted])):
                information[kind] -= rows.T @ rows
        weighted = (self.residuals * weights[:, None]).reshape(len(self.residuals), -1)
        rows = self.jacobians.reshape(*weighted.shape, -1)
        return information, (weighted[:, None] @ rows)[:, 0]

    @cached_property
    def _information(self) -> np.ndarray:
        """J' J (kind, P, P)."""
        kinds, count, _, size = self.jacobians.shape
        information = np.zeros((kinds, size, size))
        for kind, rows in self._scaled(np.arange(count), np.ones(count)):
            information[kind] += rows.T @ rows
        return information

    def _scaled(self, rows: np.ndarray, factors: np.ndarray) -> Iterator[tuple[int, np.ndarray]]:
        """Blocks of the Jacobians (row, P) of some rows times their factors, each with its kind."""
        for first in range(0, len(rows), BLOCK):
            block, scale = rows[first : first + BLOCK], factors[first : first + BLOCK, None, None]
            for kind, jacobians in enumerate(self.jacobians):
                yield kind, (jacobians[block] * scale).reshape(-1, jacobians.shape[-1])
