"""What the rows so far say: the arm's errors, the error that is left, and what to measure next.

All of it follows from the rows alone, without what an earlier update found: a calibration that was
killed goes on as if it had not been. That is fast enough without many waves and a process.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.distance import cdist

from recalib.identification.calibration import Calibration, most_probable
from recalib.identification.checks.diagnostics import FEWEST
from recalib.identification.design import most_informative
from recalib.identification.initial_estimate import SPARE, fewest
from recalib.identification.model.error_model import JOINT_ERRORS, OFFSETS
from recalib.identification.model.frames import Frames
from recalib.identification.model.linearisation import LEVER
from recalib.identification.model.observations import Observations
from recalib.identification.validation import OUTLYING
from recalib.laboratory.live.allowed import AllowedPostures
from recalib.laboratory.propose import PROBES, variances
from recalib.laboratory.tables.description import Description
from recalib.laboratory.tables.knowledge import checked_frames
from recalib.nominal.kinematics import Arm
from recalib.station.guarded import REACHED

MODELS = OFFSETS, JOINT_ERRORS  # of which the more probable one is used
FIRST = 20  # rows that tell where instrument and target are, to start from: more take longer
LAST = 8  # rows whose prediction is compared with what was measured
AHEAD = 10  # postures that have to be of use, or none is
WILD, FAR = 10.0, 0.05  # standard deviations and m off a prediction: no outlier is both


@dataclass(frozen=True)
class PredictedError:
    """The mean error of position [m] that is to be expected in allowed postures.

    Attributes:
        by_model: from the uncertainty of the parameters, and the noise.
        by_rows: how far the last rows were from what those before them predicted; infinite while
            they are too few. It holds what no parameter describes.
        ahead: `by_model`, once the ten most informative postures are measured.
    """

    by_model: float
    by_rows: float
    ahead: float

    @property
    def total(self) -> float:
        """The larger of the two."""
        return max(self.by_model, self.by_rows)


class RunningCalibration:
    """Calibrations of an arm from rows that become more: geometry, and joint errors if it has any.

    Args:
        arm: the nominal one.
        description: frames that are known.
        postures: that may be measured.
    """

    def __init__(self, arm: Arm, description: Description, postures: AllowedPostures):
        self._arm, self._description, self._postures = arm, description, postures
        self._frames: dict[int, Frames] = {}  # by the number of rows that they are from
        self._calibrations: dict[int, Calibration] = {}

    @staticmethod
    def is_ready(observations: Observations) -> bool:
        """Whether the rows are enough for a calibration."""
        return len(observations) >= fewest(observations) + SPARE

    def is_settled(self, observations: Observations) -> bool:
        """Whether `PredictedError.by_rows` is no longer that of the first, poor calibrations."""
        return self.is_ready(observations[: max(0, len(observations) - 2 * LAST)])

    def calibration(self, observations: Observations) -> Calibration:
        """From all rows. Raises RecalibError: they do not fit the arm."""
        count, some = len(observations), min(FIRST, len(observations))
        if some not in self._frames:
            given = self._description.instrument, self._description.target
            self._frames[some] = checked_frames(self._arm, observations[:some], *given)
        if count not in self._calibrations:
            frames = self._frames[some]
            self._calibrations[count] = most_probable(self._arm, MODELS, observations, frames)
        return self._calibrations[count]

    def error(self, observations: Observations) -> PredictedError:
        """Left in the arm after the rows so far."""
        calibration = self.calibration(observations)
        further = most_informative(calibration, self._postures.joints, AHEAD)
        *_, (_, covariance) = further
        now = self._expected(calibration, self._probes).mean()
        estimate = replace(calibration.estimate, covariance=covariance)
        ahead = self._expected(replace(calibration, estimate=estimate), self._probes).mean()
        return PredictedError(float(now), self._by_rows(observations), float(ahead))

    def workspace(self, observations: Observations) -> tuple[np.ndarray, np.ndarray]:
        """Allowed postures (n, joints) [rad, m], and the deviation (n,) [m] expected in each."""
        return self._probes, self._expected(self.calibration(observations), self._probes)

    def next_posture(
        self, observations: Observations, unseen: list[np.ndarray]
    ) -> np.ndarray | None:
        """What to measure next (joints,) [rad, m]; None where all was measured.

        The one farthest from those measured while there is no calibration, then the most
        informative one. Candidates nearer to an unseen posture than to a measured one are left
        out, unless all are.

        Args:
            unseen: postures (joints,) in which the instrument did not see the target.
        """
        candidates, scale = self._postures.joints, np.where(self._arm.slides, 1.0, LEVER)
        known = np.array([*observations.joints, *unseen])
        fresh = (cdist(candidates, known, "chebyshev") > 2 * REACHED).all(axis=1)
        if not fresh.any():
            return None
        candidates = candidates[fresh]
        gaps = cdist(candidates * scale, known * scale)
        to_measured, to_unseen = np.split(gaps, [len(observations)], axis=1)
        in_sight = to_measured.min(axis=1) <= to_unseen.min(axis=1, initial=np.inf)  # most likely
        if in_sight.any():
            candidates, gaps = candidates[in_sight], gaps[in_sight]
        if not self.is_ready(observations):
            return candidates[gaps.min(axis=1).argmax()]
        ((best, _),) = most_informative(self.calibration(observations), candidates, 1)
        return candidates[best]

    def check(self, observations: Observations) -> str | None:
        """What is wrong with the last row, in words, if those before it exclude it."""
        before, last = observations[:-1], observations[-1:]
        if not self.is_ready(before):
            return None
        calibration = self.calibration(before)
        off = float(np.linalg.norm(calibration.residuals(last)[0, :3]))
        expected = float(self._expected(calibration, last.joints)[0])
        if off <= max(WILD * expected, FAR):
            return None
        return (
            f"the target was measured {1e3 * off:.0f} mm from where {len(before)} rows put it;"
            f" expected: about {1e3 * expected:.2g} mm. Has instrument or target moved?"
        )

    @property
    def _probes(self) -> np.ndarray:
        return self._postures.joints[:PROBES]

    @staticmethod
    def _expected(calibration: Calibration, joints: np.ndarray) -> np.ndarray:
        """Deviations (n,) [m] of measured positions from predicted ones."""
        model, estimate = calibration.model, calibration.estimate
        _, jacobians = model.linearise(estimate.parameters, joints, model.terms(joints))
        noise = 3 * estimate.noise[0] ** 2
        return np.sqrt(variances(jacobians, estimate.covariance) + noise)

    def _by_rows(self, observations: Observations) -> float:
        """The mean error [m] of the predictions of the last rows, each by those before it."""
        count = len(observations)
        weights = self.calibration(observations).estimate.weights
        rows = [row for row in range(count - LAST, count) if weights[row] >= OUTLYING]
        if count < FEWEST or not rows or not self.is_ready(observations[: max(0, count - LAST)]):
            return np.inf
        residuals = [
            self.calibration(observations[:row]).residuals(observations[row : row + 1])[0, :3]
            for row in rows
        ]
        return float(np.linalg.norm(residuals, axis=1).mean())
