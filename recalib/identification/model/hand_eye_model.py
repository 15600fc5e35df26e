"""The data of a hand-eye calibration, and its model of an inexact arm.

The pose of the board in the camera is M_i = X^-1 G_i Z. X is the pose of the camera at its end of
the arm (base or flange), Z the pose of the board at the other end. G_i leads from one end to the
other: it is the flange's pose F_i in the base if the camera is next to the arm, and the inverse of
F_i if the camera is on the hand.

The flange is not exactly at the reported pose. So the residual r_i, the displacement from the
predicted pose of the board to the measured one, has the covariance

    C_i = S_i + A_i D A_i',    D = diag(p^2, p^2, p^2, a^2, a^2, a^2).

S_i is the covariance from the corners' noise, A_i maps a displacement of the flange to one of the
board in the camera, and (p, a) is the pose accuracy of the arm. The lens and the scale of the print
are parameters, too; see `recalib.identification.model.optics`.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.identification.model.linearisation import LEVER, crosses, displacements
from recalib.identification.model.optics import Optics

CAMERA, TARGET = slice(6), slice(6, 12)  # the indices of the camera's and the board's parameters
ENDS = TARGET.stop
EXACT = 1e-12  # m^2, rad^2: the variance of a pose from a table
OUTLIER = 0.25  # poses with less weight are outliers


@dataclass(frozen=True)
class Sights:
    """Poses of a flange, and of a board in a camera.

    Attributes:
        flange: (n, 4, 4) m, in the arm's base, as reported by the controller.
        board: (n, 4, 4) m, in the camera, as measured.
        in_hand: whether the camera is on the hand.
        optics: the pictures' information on the board's poses; None for poses from a table.
        height: the z coordinate [m] of the board's origin, in the base if the camera is on the
            hand, else in the flange; and its standard deviation [m]. None if it is unknown.
    """

    flange: np.ndarray
    board: np.ndarray
    in_hand: bool
    optics: Optics | None = None
    height: tuple[float, float] | None = None

    def __len__(self) -> int:
        return len(self.flange)

    def __getitem__(self, rows: np.ndarray) -> "Sights":
        optics = None if self.optics is None else self.optics[rows]
        return replace(self, flange=self.flange[rows], board=self.board[rows], optics=optics)

    @cached_property
    def between(self) -> np.ndarray:
        """G (n, 4, 4): the poses of the board's end of the arm in the camera's end."""
        return np.linalg.inv(self.flange) if self.in_hand else self.flange

    @cached_property
    def corners(self) -> Optics:
        """The information from corners; for poses from a table, there is none."""
        if self.optics is not None:
            return self.optics
        exact, none = np.tile(EXACT * np.eye(6), (len(self), 1, 1)), np.zeros((len(self), 6, 0))
        return Optics(exact, none, none[:, :0], none[:, 0], exact, kinds=np.zeros(0, int))

    @property
    def axes(self) -> tuple[np.ndarray, np.ndarray]:
        """Ranges (3,) [deg] of the flange's turns about three axes, largest first, and these axes.

        The turns are from the mean orientation; the axes are the rows (3, 3), in the base frame.
        """
        middle = Rotation.from_matrix(self.flange[:, :3, :3]).mean()
        turns = Rotation.from_matrix(self.flange[:, :3, :3] @ middle.as_matrix().T).as_rotvec()
        axes = np.linalg.svd(turns, full_matrices=len(turns) < 3)[2]
        return np.degrees(np.ptp(turns @ axes.T, axis=0)), axes


@dataclass(frozen=True)
class HandEye:
    """A hand-eye calibration.

    Attributes:
        sights: the data.
        camera: X (4, 4) m, in the flange if it is on the hand, else in the base.
        board: Z (4, 4) m, in the base if the camera is on the hand, else in the flange.
        optics: (o,) corrections; see `Optics`.
        accuracy: m and rad, standard deviations of the flange's pose along and about each axis.
        noise: m and rad, additional standard deviations of poses from a table, along the line of
            sight and about each axis.
        covariance: (12 + o, 12 + o) of camera, board and optics; poses are in m and rad, along the
            axes of the frames in which they are given.
        weights: (n,) up to about 1; small if a pose is doubtful.
    """

    sights: Sights
    camera: np.ndarray
    board: np.ndarray
    optics: np.ndarray
    accuracy: np.ndarray
    noise: np.ndarray
    covariance: np.ndarray
    weights: np.ndarray

    @classmethod
    def at(cls, sights: Sights, camera: np.ndarray, board: np.ndarray) -> "HandEye":
        """A calibration with these poses of camera and board, and all else at its default."""
        optics, nothing = np.zeros(sights.corners.slopes.shape[-1]), np.zeros(2)
        blank = optics, nothing, nothing, np.zeros((0, 0))  # the covariance is not known yet
        return cls(sights, camera, board, *blank, np.ones(len(sights)))

    def predict(self, sights: Sights) -> np.ndarray:
        """Poses (n, 4, 4) [m] of the board in the camera."""
        return np.linalg.inv(self.camera) @ sights.between @ self.board

    def residuals(self, sights: Sights) -> np.ndarray:
        """Displacements (n, 6) [m, rad] from the predicted poses of the board to the measured."""
        there = displacements(self.predict(sights), sights.board)
        return there + sights.corners.slopes @ self.optics

    @property
    def misfit(self) -> float:
        """The median residual [m], in which a turn of one rad counts as `LEVER`."""
        residuals = self.residuals(self.sights) * np.repeat([1.0, LEVER], 3)
        return float(np.median(np.linalg.norm(residuals, axis=1)))

    @property
    def outliers(self) -> np.ndarray:
        """The numbers, from 0, of the poses with hardly any weight."""
        return np.flatnonzero(self.weights < OUTLIER)

    def deviations(self, part: int) -> tuple[float, float]:
        """Standard deviations [m, rad] of the camera (0) or board (1) along their worst axes."""
        return worst_axes(self.covariance[6 * part : 6 * part + 6, 6 * part : 6 * part + 6])


def worst_axes(covariance: np.ndarray) -> tuple[float, float]:
    """Standard deviations [m, rad] along the worst axes, from a pose's covariance (6, 6)."""
    blocks = covariance[:3, :3], covariance[3:, 3:]
    worst = (float(np.linalg.eigvalsh(block)[-1]) for block in blocks)
    position, turn = (float(np.sqrt(max(0.0, variance))) for variance in worst)
    return position, turn


class LinearHandEye:
    """The residuals of a calibration, and their slopes by its parameters and by the flange."""

    def __init__(self, found: HandEye):
        self.found, sights = found, found.sights
        predicted = found.predict(sights)
        to_camera = np.tile(found.camera[:3, :3].T, (len(sights), 1, 1))  # from the camera's end
        from_board = to_camera @ sights.between[:, :3, :3]  # from the board's end
        self.residuals = found.residuals(sights)
        slopes = np.zeros((len(sights), 6, ENDS + len(found.optics)))
        slopes[:, :3, :3] = slopes[:, 3:, 3:6] = -to_camera
        slopes[:, :3, 3:6] = crosses(predicted[:, :3, 3]) @ to_camera
        slopes[:, :3, 6:9] = slopes[:, 3:, 9:12] = from_board
        slopes[..., ENDS:] = -sights.corners.slopes
        self.slopes = slopes
        # slopes of the board in the camera by the flange, along and about the camera's axes
        flange = found.board if sights.in_hand else sights.flange @ found.board
        lever = flange[..., :3, 3] - sights.flange[:, :3, 3]
        turn = from_board if sights.in_hand else to_camera  # from the base frame to the camera's
        self.by_flange = np.zeros((len(sights), 6, 6))
        self.by_flange[:, :3, :3] = self.by_flange[:, 3:, 3:] = turn
        self.by_flange[:, :3, 3:] = -turn @ crosses(lever)
        self.sight = predicted[:, :3, 3] / np.linalg.norm(predicted[:, :3, 3], axis=1)[:, None]

    def covariances(self, accuracy: np.ndarray, noise: np.ndarray) -> np.ndarray:
        """C (n, 6, 6), without weights."""
        scaled = self.by_flange * np.repeat(accuracy, 3)
        total = self.found.sights.corners.spread + scaled @ scaled.swapaxes(1, 2)
        total[:, :3, :3] += noise[0] ** 2 * self.sight[:, :, None] * self.sight[:, None]
        total[:, 3:, 3:] += noise[1] ** 2 * np.eye(3)
        return total

    @cached_property
    def precisions(self) -> np.ndarray:
        """Inverses (n, 6, 6) of C."""
        return np.linalg.inv(self.covariances(self.found.accuracy, self.found.noise))

    def whitened(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Weighted residuals (n, 6), and their slopes by parameters and flange, over the noise."""
        # of exact poses, rounding leaves no precision positive definite; covariances are
        covariances = self.covariances(self.found.accuracy, self.found.noise)
        roots = np.linalg.inv(np.linalg.cholesky(covariances))
        roots = roots * np.sqrt(self.found.weights)[:, None, None]
        residuals = np.einsum("nij,nj->ni", roots, self.residuals)
        by_flange = roots @ self.by_flange * np.repeat(self.found.accuracy, 3)
        return residuals, roots @ self.slopes, by_flange

    def normal_equations(
        self, precisions: np.ndarray, weights: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """The information (p, p) and the gradient (p,), from rows, corners and priors."""
        found, corners = self.found, self.found.sights.corners
        slopes = self.slopes.reshape(6 * len(weights), -1)
        weighted = (weights[:, None, None] * precisions @ self.slopes).reshape(slopes.shape)
        information, gradient = slopes.T @ weighted, self.residuals.ravel() @ weighted
        known = corners.information.sum(axis=0) + np.diag(corners.deviations**-2.0)
        information[ENDS:, ENDS:] += known
        gradient[ENDS:] += corners.gradient.sum(axis=0) - known @ found.optics
        if found.sights.height is not None:
            height, deviation = found.sights.height
            information[8, 8] += deviation**-2
            gradient[8] += (height - found.board[2, 3]) / deviation**2
        return information, gradient

    def unlikelihood(self, accuracy: np.ndarray, noise: np.ndarray) -> float:
        """Twice the negative logarithm of the restricted likelihood, up to a constant."""
        weights, rows = self.found.weights, self.residuals
        weights = np.where(weights < min(OUTLIER, np.median(weights)), 0.0, weights)
        covariances = self.covariances(accuracy, noise)
        precisions = np.linalg.inv(covariances)
        information, gradient = self.normal_equations(precisions, weights)
        scale = 1 / np.sqrt(np.maximum(information.diagonal(), np.finfo(float).tiny))
        scaled = information * scale * scale[:, None] + 1e-9 * np.eye(len(scale))
        gain = (gradient * scale) @ np.linalg.solve(scaled, gradient * scale)
        squares = np.sum(weights[:, None] * rows * (precisions @ rows[..., None])[..., 0]) - gain
        volume = np.linalg.slogdet(scaled)[1] - 2 * np.log(scale).sum()
        return float(np.linalg.slogdet(covariances)[1][weights > 0].sum() + squares + volume)
