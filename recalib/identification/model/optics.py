"""Poses measured by cameras: their uncertainty, and their dependence on lens and board.

Errors of the assumed lens and board move all poses together. They are parameters of the fit, like
those of the arm.
"""

from dataclasses import dataclass, replace

import numpy as np

# Each has a name, a unit, the size of this unit in the unit of the parameters, and the prior
# standard deviation in this unit. A printer's scale is off by about a thousandth.
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
        spread: (n, 6, 6) covariances of displacements from the noise of the corners.
        slopes: (n, 6, o) of the measured poses by the optics.
        information: (n, o, o) of the pictures on the optics, whatever the poses are.
        gradient: (n, o) that belongs to the information; its sum is zero at the best optics.
        pixels: (n, 6, 6) maps displacements to vectors whose norm is the corners' rms motion [px].
        whitening: (n, 6, 6) maps displacements to independent components, scaled to the noise of a
            typical row: three in m, then three in rad.
        kinds: (o,) the index of each parameter in `OPTICS`; default: 0, 1, 2, ..., for one board
            and one camera.
    """

    spread: np.ndarray
    slopes: np.ndarray
    information: np.ndarray
    gradient: np.ndarray
    pixels: np.ndarray
    whitening: np.ndarray = None  # type: ignore[assignment]  # __post_init__ makes it
    kinds: np.ndarray = None  # type: ignore[assignment]  # likewise

    def __post_init__(self) -> None:
        if self.whitening is None:  # as for an arm of perfect repeatability
            object.__setattr__(self, "whitening", _whitening(self.spread))
        if self.kinds is None:
            object.__setattr__(self, "kinds", np.arange(self.slopes.shape[-1]))

    def with_noise(self, covariance: np.ndarray) -> "Optics":
        """The same optics, with a covariance (6, 6) added to the noise of displacements."""
        return replace(self, whitening=_whitening(self.spread + covariance))

    def __getitem__(self, rows: np.ndarray | slice) -> "Optics":
        some = {name: values[rows] for name, values in vars(self).items() if name != "kinds"}
        return replace(self, **some)

    @property
    def length(self) -> float:
        """The rms position noise [m] of a picture."""
        return float(np.sqrt(np.trace(self.spread[:, :3, :3], axis1=1, axis2=2).mean()))

    def moved(self, displacements: np.ndarray) -> np.ndarray:
        """The rms motion (n,) [px] of each picture's corners by displacements (n, 6)."""
        return np.linalg.norm(np.einsum("nij,nj->ni", self.pixels, displacements), axis=1)

    def across(self, pixels: np.ndarray) -> np.ndarray:
        """Lengths (n,) [m] at the board, across the line of sight, of motions (n,) in pixels."""
        return pixels / np.linalg.norm(self.pixels[..., :3], 2, axis=(1, 2))

    @property
    def lines(self) -> np.ndarray:
        """Unit vectors (n, 3) along the lines of sight, the shifts that move corners the least."""
        return np.linalg.svd(self.pixels[..., :3])[2][:, -1]

    @property
    def noise(self) -> float:
        """The rms noise [m] of the corners at the board, across the line of sight."""
        squares = np.einsum("nij,njk,nik->n", self.pixels, self.spread, self.pixels)
        return float(np.sqrt(np.mean(self.across(np.sqrt(squares)) ** 2)))

    @property
    def deviations(self) -> np.ndarray:
        """Prior standard deviations (o,) of the optics."""
        return np.array([OPTICS[kind][2] * OPTICS[kind][3] for kind in self.kinds])


def _whitening(spread: np.ndarray) -> np.ndarray:
    variances = np.diagonal(spread, axis1=1, axis2=2).reshape(-1, 2, 3)
    typical = np.sqrt(np.median(variances, axis=(0, 2)))
    roots = np.linalg.cholesky(np.linalg.inv(spread)).swapaxes(1, 2)
    return np.repeat(typical, 3)[:, None] * roots
