"""What the rows so far say: the arm's errors, the error that is left, and what to measure next.

All of it follows from the rows alone, without what an earlier update found: a calibration that was
killed goes on as if it had not been. That is fast enough without many waves and a process.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.distance import cdist

from recalib.identification.calibration import Calibration, most_probable
from recalib.identification.checks.diagnostics import FEWEST
from recalib.identification.checks.repeatability import weigh
from recalib.identification.design import most_informative
from recalib.identification.initial_estimate import SPARE, fewest
from recalib.identification.model.error_model import JOINT_ERRORS, OFFSETS, ErrorModel
from recalib.identification.model.frames import Frames
from recalib.identification.model.linearisation import LEVER
from recalib.identification.model.observations import Observations
from recalib.identification.model.optics import Optics
from recalib.identification.validation import OUTLYING
from recalib.laboratory.live.allowed import AllowedPostures
from recalib.laboratory.live.record import Pictures
from recalib.laboratory.propose import PROBES, variances
from recalib.laboratory.tables.description import Description
from recalib.laboratory.tables.knowledge import checked_frames
from recalib.nominal.kinematics import Arm
from recalib.station.guarded import REACHED

MODELS = OFFSETS, JOINT_ERRORS  # of which the more probable one is used
FIRST = 20  # rows that tell where instrument and target are, to start from: more take longer
RETURNING = slice(60)  # rows that tell how well the arm returns, for the same reason
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
    """

    by_model: float
    by_rows: float

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
        pictures: by which the rows are measured, if cameras do it.
    """

    def __init__(
        self,
        arm: Arm,
        description: Description,
        postures: AllowedPostures,
        pictures: Pictures | None = None,
    ):
        self._arm, self._description, self._postures = arm, description, postures
        self._pictures = pictures
        self._scale = np.where(arm.slides, 1.0, LEVER)  # m for a rad, or for a m
        self._frames: dict[int, Frames] = {}  # by the number of rows that they are from
        self._calibrations: dict[int, Calibration] = {}
        self._whitening: dict[int, np.ndarray] = {}  # that takes into account how the arm returns

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
            poses = replace(observations[:some], optics=None)
            self._frames[some] = checked_frames(self._arm, poses, *given)
        if count not in self._calibrations:
            frames = self._frames[some]
            if observations.optics is not None:
                frames = frames.with_optics(observations.optics)
                observations = weigh(
                    ErrorModel(self._arm, OFFSETS, frames), observations, RETURNING
                )
                assert observations.optics is not None
                self._whitening[count] = observations.optics.whitening
            self._calibrations[count] = most_probable(self._arm, MODELS, observations, frames)
        return self._calibrations[count]

    def error(self, observations: Observations) -> PredictedError:
        """Left in the arm after the rows so far."""
        by_model = self._expected(self.calibration(observations), self._probes, observations.optics)
        return PredictedError(float(by_model.mean()), self._by_rows(observations))

    def gain(self, observations: Observations, unseen: list[np.ndarray]) -> float:
        """The part of `PredictedError.by_model` that the next postures would take away.

        These are the most informative ones; `unseen` as in `next_posture`.
        """
        further = [*self._most_informative(observations, unseen, AHEAD)]
        if not further:
            return 0.0
        calibration, (_, covariance) = self.calibration(observations), further[-1]
        estimate = replace(calibration.estimate, covariance=covariance)
        now, then = (
            self._expected(its, self._probes, observations.optics).mean()
            for its in (calibration, replace(calibration, estimate=estimate))
        )
        return float(1 - then / now)

    def workspace(self, observations: Observations) -> tuple[np.ndarray, np.ndarray]:
        """Allowed postures (n, joints) [rad, m], and the deviation (n,) [m] expected in each."""
        calibration = self.calibration(observations)
        return self._probes, self._expected(calibration, self._probes, observations.optics)

    def next_posture(
        self, observations: Observations, unseen: list[np.ndarray]
    ) -> np.ndarray | None:
        """What to measure next (joints,) [rad, m]; None where all was measured.

        The one farthest from those measured while there is no calibration, then the most
        informative one. Candidates nearer to an unseen posture than to a measured one are left
        out, and the more often the target was out of sight, the nearer they are to measured ones.
        So are those where a camera would see less than half of its board. Something is left.

        Args:
            unseen: postures (joints,) in which the instrument did not see the target.
        """
        if self.is_ready(observations):
            best = next((one for one, _ in self._most_informative(observations, unseen, 1)), None)
            return None if best is None else self._postures.joints[best]
        numbers, gaps = self._candidates(observations, unseen)
        return self._postures.joints[numbers[gaps.argmax()]] if len(numbers) else None

    def _candidates(
        self, observations: Observations, unseen: list[np.ndarray]
    ) -> tuple[np.ndarray, np.ndarray]:
        """Numbers (n,) of postures to choose from, and how far (n,) [m] from known ones."""
        joints, known = self._postures.joints, np.array([*observations.joints, *unseen])
        (fresh,) = np.nonzero((cdist(joints, known, "chebyshev") > 2 * REACHED).all(axis=1))
        gaps = cdist(joints[fresh] * self._scale, known * self._scale)
        to_measured, to_unseen = np.split(gaps, [len(observations)], axis=1)
        ratios = to_measured.min(axis=1) / to_unseen.min(axis=1, initial=np.inf)
        largest = max(min(1.0, len(observations) / max(1, len(unseen))), ratios.min(initial=np.inf))
        in_sight = ratios <= largest  # most likely
        return fresh[in_sight], gaps[in_sight].min(axis=1)

    def _most_informative(
        self, observations: Observations, unseen: list[np.ndarray], count: int
    ) -> Iterator[tuple[int, np.ndarray]]:
        """Of candidates, numbers of postures as `most_informative` yields them.

        A picture has the slopes of its own posture, and counts as sure as that of the nearest one.
        """
        calibration, optics = self.calibration(observations), None
        numbers, _ = self._candidates(observations, unseen)
        if not len(numbers):
            return
        joints = self._postures.joints[numbers]
        if self._pictures is not None:
            assert observations.optics is not None
            slopes, visible = self._pictures.predict(calibration.predict(joints))
            if visible.any():
                numbers, joints, slopes = numbers[visible], joints[visible], slopes[visible]
            gaps = cdist(joints * self._scale, observations.joints * self._scale)
            nearest = gaps.argmin(axis=1)
            whitening = self._whitening[len(observations)][nearest]
            optics = replace(observations.optics[nearest], slopes=slopes, whitening=whitening)
        for best, covariance in most_informative(calibration, joints, count, optics):
            yield int(numbers[best]), covariance

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
    def _expected(
        calibration: Calibration, joints: np.ndarray, optics: Optics | None = None
    ) -> np.ndarray:
        """Deviations (n,) [m] of measured positions from predicted ones.

        By pixels, after one shift and turn of instrument and target: how far away a camera is, no
        picture tells better than its board and lens are known.
        """
        model, estimate = calibration.model, calibration.estimate
        _, jacobians = model.linearise(estimate.parameters, joints, model.terms(joints))
        if optics is None:
            noise = 3 * estimate.noise[0] ** 2
        else:
            noise = optics.noise**2
            by_position = jacobians[:, :3].reshape(-1, model.deviations.size)
            ends = np.flatnonzero(model.free[: model.optics_columns.start])
            shifts = np.linalg.qr(by_position[:, ends]).Q
            left = by_position - shifts @ (shifts.T @ by_position)
            jacobians = left.reshape(len(joints), 3, -1)
        return np.sqrt(variances(jacobians, estimate.covariance) + noise)

    def _by_rows(self, observations: Observations) -> float:
        """The mean error [m] of the predictions of the last rows, each by those before it."""
        count = len(observations)
        weights = self.calibration(observations).estimate.weights
        rows = [row for row in range(count - LAST, count) if weights[row] >= OUTLYING]
        if count < FEWEST or not rows or not self.is_ready(observations[: max(0, count - LAST)]):
            return np.inf
        residuals = np.array(
            [
                self.calibration(observations[:row]).residuals(observations[row : row + 1])[0]
                for row in rows
            ]
        )
        if (optics := observations.optics) is None:
            return float(np.linalg.norm(residuals[:, :3], axis=1).mean())
        its = optics[np.array(rows)]
        return float(its.across(its.moved(residuals)).mean())
