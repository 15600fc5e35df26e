"""Poses that were measured by cameras: how sure they are, and how they depend on their optics.

Errors of the assumed lens and board move all poses together: they are parameters of the fit, like
the arm's.
"""

from dataclasses import dataclass, replace

import numpy as np

# By name, with its unit, the size of that in what parameters are in, and the standard deviation
# before any picture is taken, in that unit. A printer scales by a thousandth.
BOARD = (("print scale along x", "%", 0.01, 0.1), ("print scale along y", "%", 0.01, 0.1))
OPTICS = (
    *BOARD,
    *((f"focal length along {axis}", "px", 1.0, 100.0) for axis in "xy"),
    *((f"principal point along {axis}", "px", 1.0, 100.0) for axis in "xy"),
    *(
        (f"distortion {name}", "", 1.0, 1.0)
        for name in ("k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6")
    ),
)


@dataclass(frozen=True)
class Optics:
    """The information of poses from cameras, row by row. A displacement is (6,) [m, rad].

    The optics are the parameters of each board, then of each camera whose lens is estimated. Rows
    have zeros for boards and cameras other than their own.

    Attributes:
        spread: (n, 6, 6) covariances of displacements, by the noise of the corners.
        slopes: (n, 6, o) by which measured poses move with the optics.
        information: (n, o, o) of the pictures on the optics, for any poses.
        gradient: (n, o) that goes with it: its sum is zero for the best optics of the pictures.
        pixels: (n, 6, 6) to vectors as long as the root mean square of what corners move [px].
        whitening: (n, 6, 6) to displacements whose components are independent, and as large as
            a typical row's: in its first three m, then rad.
        kinds: (o,) which of `OPTICS` each is; default: the first of them, of one board and one
            camera.
    """

    spread: np.ndarray
    slopes: np.ndarray
    information: np.ndarray
    gradient: np.ndarray
    pixels: np.ndarray
    whitening: np.ndarray = None  # type: ignore[assignment]  # __post_init__ makes it
    kinds: np.ndarray = None  # type: ignore[assignment]  # likewise

    def __post_init__(self) -> None:
        if self.whitening is None:  # of an arm that returns to a posture without any error
            object.__setattr__(self, "whitening", _whitening(self.spread))
        if self.kinds is None:
            object.__setattr__(self, "kinds", np.arange(self.slopes.shape[-1]))

    def with_noise(self, covariance: np.ndarray) -> "Optics":
        """The same, where displacements have further noise of a covariance (6, 6)."""
        return replace(self, whitening=_whitening(self.spread + covariance))

    def __getitem__(self, rows: np.ndarray | slice) -> "Optics":
        some = {name: values[rows] for name, values in vars(self).items() if name != "kinds"}
        return replace(self, **some)

    @property
    def length(self) -> float:
        """m, the root mean square of what the noise of a picture moves its position."""
        return float(np.sqrt(np.trace(self.spread[:, :3, :3], axis1=1, axis2=2).mean()))

    def moved(self, displacements: np.ndarray) -> np.ndarray:
        """How far displacements (n, 6) move corners, each a root mean square: (n,) px."""
        return np.linalg.norm(np.einsum("nij,nj->ni", self.pixels, displacements), axis=1)

    def across(self, pixels: np.ndarray) -> np.ndarray:
        """What pixels (n,) are at the board, across the line of sight: (n,) m."""
        return pixels / np.linalg.norm(self.pixels[..., :3], 2, axis=(1, 2))

    @property
    def lines(self) -> np.ndarray:
        """Unit vectors (n, 3) along the lines of sight: no other shift moves corners as little."""
        return np.linalg.svd(self.pixels[..., :3])[2][:, -1]

    @property
    def noise(self) -> float:
        """m, the root mean square of what the noise of a picture moves corners, across its line."""
        squares = np.einsum("nij,njk,nik->n", self.pixels, self.spread, self.pixels)
        return float(np.sqrt(np.mean(self.across(np.sqrt(squares)) ** 2)))

    @property
    def deviations(self) -> np.ndarray:
        """Standard deviations (o,) of them, before any picture is taken."""
        return np.array([OPTICS[kind][2] * OPTICS[kind][3] for kind in self.kinds])


def _whitening(spread: np.ndarray) -> np.ndarray:
    variances = np.diagonal(spread, axis1=1, axis2=2).reshape(-1, 2, 3)
    typical = np.sqrt(np.median(variances, axis=(0, 2)))
    roots = np.linalg.cholesky(np.linalg.inv(spread)).swapaxes(1, 2)
    return np.repeat(typical, 3)[:, None] * roots
