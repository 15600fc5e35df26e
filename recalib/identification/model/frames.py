"""The frames of instruments and targets: known, or parameters like the rest."""

from dataclasses import dataclass, field, replace

import numpy as np

from recalib.identification.model.optics import Optics

# Standard deviations of the parameters before anything is known: what wear and mounting plausibly
# do to the base of an arm and to a link.
BASE = 0.05, np.radians(5)  # m, rad
LINK = 0.02, np.radians(0.5)
UNKNOWN = 0.5, np.radians(30)  # of an unknown frame, around an initial estimate
HELD = 1e-9  # of what is not identifiable from any observation: it stays as it is


@dataclass(frozen=True)
class Frames:
    """The frames at both ends of the arm, as they are before anything is identified.

    If a frame is known, a deviation that is identified there is an error of the arm's base or last
    link. If it is unknown, the deviation improves its estimate, and the arm's own base or last link
    stays nominal: it is not identifiable.

    Each row is of a sight: an instrument, and a target that it measures.

    Attributes:
        base: (4, 4) m, the pose of the arm's base in the frame of the (first) instrument.
        targets: (target, 4, 4) m, their poses in the frame of the tool.
        sockets: (socket, 3) m, estimates of their centres in the frame of the instrument, which is
            the arm's base there.
        base_deviations, target_deviations: of translation [m] and turn [rad], before anything is
            known.
        base_unknown, targets_unknown: whether they are estimates.
        optics_deviations: (o,) of the optics of cameras; default: none.
        further: (i, 4, 4) m, the pose of the base in the frames of further instruments, if there
            are any: then all frames are estimates.
        optics_kinds: (o,) which of `OPTICS` they are; default: the first of them.
        sights: (s, 2) the numbers of the instrument and of the target of each sight; default: the
            first instrument and each target.
        base_prior, target_prior: (6,) m and rad, standard deviations of the instrument's pose along
            the axes of the arm's base, and of the targets' along the tool's axes; none if they are
            unknown or exact. A frame that has them is an estimate.
        link_deviations, offset_deviation: of links [m, rad] and joint offsets [rad] before anything
            is known; the latter is by default the prior of the joint terms.
    """

    base: np.ndarray = field(default_factory=lambda: np.eye(4))
    targets: np.ndarray = field(default_factory=lambda: np.eye(4)[None])
    sockets: np.ndarray = field(default_factory=lambda: np.empty((0, 3)))
    base_deviations: tuple[float, float] = BASE
    target_deviations: tuple[float, float] = LINK
    base_unknown: bool = False
    targets_unknown: bool = False
    optics_deviations: np.ndarray = field(default_factory=lambda: np.empty(0))
    further: np.ndarray = field(default_factory=lambda: np.empty((0, 4, 4)))
    base_prior: np.ndarray = field(default_factory=lambda: np.empty(0))
    target_prior: np.ndarray = field(default_factory=lambda: np.empty(0))
    link_deviations: tuple[float, float] = LINK
    offset_deviation: float = 0.0
    optics_kinds: np.ndarray = None  # type: ignore[assignment]  # __post_init__ makes it
    sights: np.ndarray = None  # type: ignore[assignment]  # likewise

    def __post_init__(self) -> None:
        if self.optics_kinds is None:
            object.__setattr__(self, "optics_kinds", np.arange(len(self.optics_deviations)))
        if self.sights is None:
            each = np.arange(len(self.targets))
            object.__setattr__(self, "sights", np.stack([0 * each, each], axis=1))

    @property
    def bases(self) -> np.ndarray:
        """The poses (instrument, 4, 4) [m] of the arm's base in the frame of each instrument."""
        return np.concatenate([self.base[None], self.further])

    def with_priors(self, base: np.ndarray | None, target: np.ndarray | None) -> "Frames":
        """The same, of which one or both are known within deviations (6,), see above."""
        frames = self
        if base is not None:
            frames = replace(frames, base_prior=base, base_unknown=True, base_deviations=UNKNOWN)
        if target is None:
            return frames
        frames = replace(frames, target_prior=target, targets_unknown=True)
        return replace(frames, target_deviations=UNKNOWN)

    def with_optics(self, optics: Optics) -> "Frames":
        """The same, with the optics of cameras as parameters."""
        return replace(self, optics_deviations=optics.deviations, optics_kinds=optics.kinds)


def nearest_rotation(matrix: np.ndarray) -> np.ndarray:
    """The rotation R (3, 3) of the largest trace of R' M; by a matrix's scale nothing changes."""
    left, _, right = np.linalg.svd(matrix)
    return left @ np.diag([1, 1, np.linalg.det(left @ right)]) @ right
