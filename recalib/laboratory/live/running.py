"""Calibration from the rows so far, the predicted error, and the next posture to measure.

Everything is computed from the rows alone, without the state of earlier updates, so that a killed
calibration continues as if nothing had happened. Models this small are fast enough for that.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from scipy.spatial.distance import cdist

from recalib.identification.calibration import Calibration, calibrations, choose
from recalib.identification.checks.diagnostics import FEWEST
from recalib.identification.checks.scales import returning
from recalib.identification.design import most_informative, surprises
from recalib.identification.initial_estimate import SPARE, fewest
from recalib.identification.model.error_model import JOINT_ERRORS, OFFSETS, ErrorModel
from recalib.identification.model.frames import Frames
from recalib.identification.model.linearisation import LEVER
from recalib.identification.model.observations import Observations
from recalib.identification.model.optics import Optics
from recalib.laboratory.live.allowed import AllowedPostures
from recalib.laboratory.plausibility.knowledge import checked_frames
from recalib.laboratory.propose import PROBES
from recalib.laboratory.tables.description import Description
from recalib.nominal.kinematics import Arm
from recalib.station.guarded import REACHED
from recalib.station.interface import Pictures

MODELS = OFFSETS, JOINT_ERRORS  # the more probable one is used
FIRST = 20  # rows for an initial estimate of instrument and target: more take longer
RETURNING = slice(60)  # rows to estimate the arm's repeatability from: more take longer
LAST = 4  # rows that are compared with their predictions from the rows before
AHEAD = 10  # further postures by which the benefit of going on is judged
GATE, ROW = 4.0, 3  # standard deviations, and rows: so many successive rows off are no outliers
WILD, FAR = 10.0, 0.05  # standard deviations and m: even a single row farther off is no outlier


class RunningCalibration:
    """Calibrations of an arm from a growing number of rows: geometry, and joint errors if likely.

    Args:
        postures: to choose the next posture from.
        pictures: reads the pictures, if the rows are measured by a camera.
    """

    def __init__(
        self,
        arm: Arm,
        description: Description,
        postures: AllowedPostures,
        pictures: Pictures | None = None,
    ):
        self._arm, self._description, self._postures = arm, description, postures
        self._pictures, self._probes = pictures, postures.joints[:PROBES]
        self._scale = np.where(arm.slides, 1.0, LEVER)  # m for each rad, or for each m
        self._frames: dict[int, Frames] = {}  # initial estimates by the number of rows used
        self._calibrations: dict[int, Calibration] = {}
        self._returning: dict[int, np.ndarray] = {}  # covariance (6, 6) of the arm's repeatability

    @staticmethod
    def is_ready(observations: Observations) -> bool:
        """Whether the rows are enough for a calibration."""
        return len(observations) >= fewest(observations) + SPARE

    def calibration(self, observations: Observations) -> Calibration:
        """The calibration from all rows. Raises RecalibError if they do not fit the arm."""
        count, some = len(observations), min(FIRST, len(observations))
        if some not in self._frames:
            poses = replace(observations[:some], optics=None)
            self._frames[some] = checked_frames(self._arm, poses, self._description)
        if count not in self._calibrations:
            frames = self._frames[some]
            if observations.optics is not None:
                frames = frames.with_optics(observations.optics)
                model = ErrorModel(self._arm, OFFSETS, frames)
                self._returning[count] = returning(model, observations[RETURNING])
                observations = self._weighed(observations, count)
            every = calibrations(self._arm, MODELS, observations, frames)
            self._calibrations[count] = every[choose(every)]
        return self._calibrations[count]

    def _weighed(self, observations: Observations, count: int) -> Observations:
        """Rows of a camera with the noise that the calibration of `count` rows assumes."""
        if observations.optics is None:
            return observations
        return observations.with_noise(self._returning[count])

    def error(self, observations: Observations) -> float:
        """The predicted mean position error [m] in allowed postures.

        It includes the noise, because noise and errors that no parameter describes cannot be
        distinguished. The uncertainty of the parameters is scaled by the errors of predictions of
        the last rows from the rows before. Infinite while there are too few rows.
        """
        if len(observations) < FEWEST:
            return np.inf
        optics, calibration = observations.optics, self.calibration(observations)
        surprise = self._surprise(observations)
        return float(self._expected(calibration, self._probes, optics, surprise).mean())

    def gain(self, observations: Observations, avoided: list[np.ndarray]) -> float:
        """The fraction by which the most informative postures would reduce the predicted error."""
        further = [*self._most_informative(observations, avoided, AHEAD)]
        if not further:
            return 0.0
        calibration, (_, covariance) = self.calibration(observations), further[-1]
        estimate = replace(calibration.estimate, covariance=covariance)
        now, then = (
            self._expected(one, self._probes, observations.optics).mean()
            for one in (calibration, replace(calibration, estimate=estimate))
        )
        return float(1 - then / now)

    def workspace(self, observations: Observations) -> tuple[np.ndarray, np.ndarray]:
        """Allowed postures (n, joints) [rad, m], and the expected error (n,) [m] in each."""
        calibration = self.calibration(observations)
        return self._probes, self._expected(calibration, self._probes, observations.optics)

    def next_posture(
        self, observations: Observations, avoided: list[np.ndarray]
    ) -> np.ndarray | None:
        """The next posture (joints,) [rad, m]; None if all were measured.

        While there is no calibration, it is the one farthest from all measured postures; later, the
        most informative one. Candidates nearer to an avoided posture (joints,) than to a measured
        one are left out; the more postures are avoided, the nearer candidates are to measured ones.
        Candidates in which a camera would see less than half of its board are left out, too, unless
        no others remain. Postures are avoided if the target was not seen there, or if skipped.
        """
        if self.is_ready(observations):
            best = next((one for one, _ in self._most_informative(observations, avoided, 1)), None)
            return None if best is None else self._postures.joints[best]
        numbers, gaps = self._candidates(observations, avoided)
        return self._postures.joints[numbers[gaps.argmax()]] if len(numbers) else None

    def _candidates(
        self, observations: Observations, avoided: list[np.ndarray]
    ) -> tuple[np.ndarray, np.ndarray]:
        """Indices (n,) of postures to choose from, and their distances (n,) [m] to known ones."""
        joints, known = self._postures.joints, np.array([*observations.joints, *avoided])
        (fresh,) = np.nonzero((cdist(joints, known, "chebyshev") > 2 * REACHED).all(axis=1))
        gaps = cdist(joints[fresh] * self._scale, known * self._scale)
        to_measured, to_avoided = np.split(gaps, [len(observations)], axis=1)
        ratios = to_measured.min(axis=1) / to_avoided.min(axis=1, initial=np.inf)
        share = min(1.0, len(observations) / max(1, len(avoided)))
        largest = max(share, ratios.min(initial=np.inf))
        in_sight = ratios <= largest  # the target is most likely visible there
        return fresh[in_sight], gaps[in_sight].min(axis=1)

    def _most_informative(
        self, observations: Observations, avoided: list[np.ndarray], count: int
    ) -> Iterator[tuple[int, np.ndarray]]:
        """Indices of postures and covariances, as `most_informative` yields them for candidates.

        A predicted picture has the slopes of its own posture, and the noise of the nearest picture.
        """
        calibration, optics = self.calibration(observations), None
        numbers, _ = self._candidates(observations, avoided)
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
            weighed = self._weighed(observations, len(observations)).optics
            assert weighed is not None
            optics = replace(weighed[nearest], slopes=slopes)
        for best, covariance in most_informative(calibration, joints, count, optics):
            yield int(numbers[best]), covariance

    def check(self, observations: Observations) -> str | None:
        """A message if the last rows contradict the rows before; otherwise None."""
        for count, gate, far in ((1, WILD, FAR), (ROW, GATE, 0.0)):
            before = len(observations) - count
            # the covariances of the first calibrations are too optimistic
            fewest = FEWEST if count == ROW else 0
            if before < fewest or not self.is_ready(observations[: max(0, before)]):
                continue
            calibration = self.calibration(observations[:before])
            last = self._weighed(observations, before)[before:]
            limit = gate**2 * self._surprise(observations[:before])
            off = np.linalg.norm(calibration.residuals(last)[:, :3], axis=1)
            if off.min() > far and (surprises(calibration, last) > limit).all():
                expected = 1e3 * float(self._expected(calibration, last.joints).mean())
                measured = ", ".join(f"{1e3 * gap:.2g}" for gap in off)
                rows = f"row {before + 1}" if count == 1 else f"rows {before + 1} to {before + ROW}"
                return (
                    f"in {rows} the target was measured {measured} mm from its prediction by the"
                    f" {before} rows before; expected: about {expected:.2g} mm. The instrument or"
                    " the target may have moved; try: put it back, or begin a new table"
                )
        return None

    def _surprise(self, observations: Observations) -> float:
        """The median surprise of the last rows, each by the rows before it; at least 1."""
        count, found = len(observations), [1.0]
        for before in range(count - LAST, count):
            if self.is_ready(observations[: max(0, before)]):
                calibration = self.calibration(observations[:before])
                row = self._weighed(observations, before)[before : before + 1]
                found.append(float(surprises(calibration, row)[0]))
        return max(1.0, float(np.median(found[1:] or found)))

    @staticmethod
    def _expected(
        calibration: Calibration,
        joints: np.ndarray,
        optics: Optics | None = None,
        surprise: float = 1.0,
    ) -> np.ndarray:
        """Expected deviations (n,) [m] of measured positions from predicted ones.

        With cameras, after a common shift and turn of both ends, with the noise across their lines.
        """
        noise = 3 * calibration.estimate.noise[0] ** 2 if optics is None else optics.noise**2
        spread = calibration.position_covariances(joints, shifted=optics is not None)
        return np.sqrt(surprise * np.trace(spread, axis1=1, axis2=2) + noise)
