"""The frames of instruments and targets: known, or estimated like the other parameters."""

from dataclasses import dataclass, field, replace

import numpy as np

from recalib.identification.model.optics import Optics

# Prior standard deviations of the parameters: plausible effects of wear and mounting on the base of
# an arm and on a link.
BASE = 0.05, np.radians(5)  # m, rad
LINK = 0.02, np.radians(0.5)
UNKNOWN = 0.5, np.radians(30)  # of an unknown frame, around its initial estimate
HELD = 1e-9  # of a parameter that no observation can identify: it stays at its initial value
EXACT = 1e-6  # m, rad: deviation of a number without one, if other numbers of the pose have one


@dataclass(frozen=True)
class Frames:
    """The frames at both ends of the arm, before the identification.

    A deviation that is identified at a known frame is an error of the arm's base or last link. At
    an unknown frame, it improves the estimate of the frame, and the arm's own base or last link
    stays nominal, because it is not identifiable.

    Each row belongs to a sight: an instrument and a target that it measures.

    Attributes:
        base: (4, 4) m, the pose of the arm's base in the frame of the (first) instrument.
        targets: (target, 4, 4) m, the targets' poses in the frame of the tool.
        sockets: (socket, 3) m, estimates of the sockets' centres in the frame of the instrument,
            which is the frame of the arm's base in this case.
        base_deviations, target_deviations: prior deviations of translation [m] and turn [rad].
        base_unknown, targets_unknown: whether the frames are estimates.
        optics_deviations: (o,) prior deviations of the cameras' optics; default: no optics.
        further: (i, 4, 4) m, the pose of the base in the frames of further instruments. If there
            are any, all frames are estimates.
        optics_kinds: (o,) the index of each in `OPTICS`; default: 0, 1, 2, ...
        sights: (s, 2) the numbers of the instrument and of the target of each sight; default: the
            first instrument and each target.
        base_prior, target_prior: (6,) m and rad, standard deviations of the instrument's pose along
            the axes of the arm's base, and of the targets' along the tool's axes; empty if a frame
            is unknown or exact. A frame with such a prior is an estimate.
        link_deviations, offset_deviation: prior deviations of links [m, rad] and joint offsets
            [rad]; by default (0), offsets have the prior of the joint terms.
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
        """The same frames, of which one or both are known within deviations (6,); see above."""
        frames = self
        if base is not None:
            frames = replace(frames, base_prior=base, base_unknown=True, base_deviations=UNKNOWN)
        if target is None:
            return frames
        frames = replace(frames, target_prior=target, targets_unknown=True)
        return replace(frames, target_deviations=UNKNOWN)

    def with_optics(self, optics: Optics) -> "Frames":
        """The same frames, with the optics of cameras as parameters."""
        return replace(self, optics_deviations=optics.deviations, optics_kinds=optics.kinds)


def nearest_rotation(matrix: np.ndarray) -> np.ndarray:
    """The rotation R (3, 3) that maximises the trace of R' M; the scale of M does not matter."""
    left, _, right = np.linalg.svd(matrix)
    return left @ np.diag([1, 1, np.linalg.det(left @ right)]) @ right
