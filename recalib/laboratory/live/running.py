"""By the rows so far: the arm's errors, the remaining error, and what to measure next.

All of it follows from the rows alone, without what an earlier update found: a calibration that was
killed goes on as if it had not been. That is fast enough without many waves and a process.
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
from recalib.laboratory.live.record import Pictures
from recalib.laboratory.plausibility.knowledge import checked_frames
from recalib.laboratory.propose import PROBES
from recalib.laboratory.tables.description import Description
from recalib.nominal.kinematics import Arm
from recalib.station.guarded import REACHED

MODELS = OFFSETS, JOINT_ERRORS  # of which the more probable one is used
FIRST = 20  # rows for an initial estimate of instrument and target: more take longer
RETURNING = slice(60)  # rows to estimate how well the arm returns, for the same reason
LAST = 4  # rows whose predictions, each by the rows before it, are compared with them
AHEAD = 10  # postures that have to be of use, or none is
GATE, ROW = 4.0, 3  # standard deviations; so many rows in a row farther off are no outliers
WILD, FAR = 10.0, 0.05  # standard deviations and m: one row as far off is no outlier, either


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
        self._returning: dict[int, np.ndarray] = {}  # the covariance (6, 6) of how the arm returns

    @staticmethod
    def is_ready(observations: Observations) -> bool:
        """Whether the rows are enough for a calibration."""
        return len(observations) >= fewest(observations) + SPARE

    def calibration(self, observations: Observations) -> Calibration:
        """From all rows. Raises RecalibError: they do not fit the arm."""
        count, some = len(observations), min(FIRST, len(observations))
        if some not in self._frames:
            given = self._description.instrument, self._description.target
            poses = replace(observations[:some], optics=None)
            frames = checked_frames(self._arm, poses, *given)
            self._frames[some] = self._description.stated_in(frames)
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
        """Rows by cameras, weighed as by the calibration of so many rows."""
        if observations.optics is None:
            return observations
        return observations.with_noise(self._returning[count])

    def error(self, observations: Observations) -> float:
        """The predicted mean position error [m] in allowed postures.

        It includes the noise, from which errors that no parameter describes cannot be
        distinguished. The parameters' uncertainty is scaled by how far the last rows were off
        predictions from those before them. Infinite while there are too few rows.
        """
        if len(observations) < FEWEST:
            return np.inf
        optics, calibration = observations.optics, self.calibration(observations)
        surprise = self._surprise(observations)
        return float(self._expected(calibration, self._probes, optics, surprise).mean())

    def gain(self, observations: Observations, avoided: list[np.ndarray]) -> float:
        """The fraction by which the next postures would reduce the predicted error.

        These are the most informative ones, without `avoided` as in `next_posture`.
        """
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
        """Allowed postures (n, joints) [rad, m], and the deviation (n,) [m] expected in each."""
        calibration = self.calibration(observations)
        return self._probes, self._expected(calibration, self._probes, observations.optics)

    def next_posture(
        self, observations: Observations, avoided: list[np.ndarray]
    ) -> np.ndarray | None:
        """The next posture (joints,) [rad, m]; None if all were measured.

        The one farthest from those measured while there is no calibration, then the most
        informative one. Candidates nearer to an avoided posture than to a measured one are left
        out, and the more are avoided, the nearer candidates are to measured ones. So are those
        where a camera would see less than half of its board, unless nothing else remains.

        Args:
            avoided: postures (joints,) in which the target was not seen, or that were skipped.
        """
        if self.is_ready(observations):
            best = next((one for one, _ in self._most_informative(observations, avoided, 1)), None)
            return None if best is None else self._postures.joints[best]
        numbers, gaps = self._candidates(observations, avoided)
        return self._postures.joints[numbers[gaps.argmax()]] if len(numbers) else None

    def _candidates(
        self, observations: Observations, avoided: list[np.ndarray]
    ) -> tuple[np.ndarray, np.ndarray]:
        """Numbers (n,) of postures to choose from, and how far (n,) [m] from known ones."""
        joints, known = self._postures.joints, np.array([*observations.joints, *avoided])
        (fresh,) = np.nonzero((cdist(joints, known, "chebyshev") > 2 * REACHED).all(axis=1))
        gaps = cdist(joints[fresh] * self._scale, known * self._scale)
        to_measured, to_avoided = np.split(gaps, [len(observations)], axis=1)
        ratios = to_measured.min(axis=1) / to_avoided.min(axis=1, initial=np.inf)
        share = min(1.0, len(observations) / max(1, len(avoided)))
        largest = max(share, ratios.min(initial=np.inf))
        in_sight = ratios <= largest  # most likely
        return fresh[in_sight], gaps[in_sight].min(axis=1)

    def _most_informative(
        self, observations: Observations, avoided: list[np.ndarray], count: int
    ) -> Iterator[tuple[int, np.ndarray]]:
        """Of candidates, numbers of postures as `most_informative` yields them.

        A picture has the slopes of its own posture, and counts as sure as the nearest picture.
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
        """A message if the last rows contradict those before; otherwise None."""
        for count, gate, far in ((1, WILD, FAR), (ROW, GATE, 0.0)):
            before = len(observations) - count
            # the first calibrations are worse than their covariances
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
        """How much the last rows surprised calibrations of those before them; at least 1."""
        count, found = len(observations), [1.0]
        for before in range(count - LAST, count):
            if self.is_ready(observations[: max(0, before)]):
                calibration = self.calibration(observations[:before])
                row = self._weighed(observations, before)[before : before + 1]
                found.append(float(surprises(calibration, row)[0]))
        return max(1.0, float(np.median(found[1:] or found)))

    @property
    def _probes(self) -> np.ndarray:
        return self._postures.joints[:PROBES]

    @staticmethod
    def _expected(
        calibration: Calibration,
        joints: np.ndarray,
        optics: Optics | None = None,
        surprise: float = 1.0,
    ) -> np.ndarray:
        """Deviations (n,) [m] of measured positions from predicted ones.

        By cameras after one shift and turn of both ends, and with the noise across their lines.
        """
        noise = 3 * calibration.estimate.noise[0] ** 2 if optics is None else optics.noise**2
        spread = calibration.position_covariances(joints, shifted=optics is not None)
        return np.sqrt(surprise * np.trace(spread, axis1=1, axis2=2) + noise)
