"""A calibrated arm in one self-contained file, and commands that take the real arm to poses.

The file is an archive (`recalib.files.archives`). Its header holds the format's version, the
nominal arm's base and tool link, and the names of the targets. Its arrays hold the bytes of the
arm's URDF, the state of the calibration, and the measured joint coordinates.

The commands are the paper's own idea: the controller gets a *fake* pose. With its nominal
kinematics, it turns this pose into the joints that take the real arm to the desired pose.
"""

import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from recalib.errors import InvalidSetting, check_kind, check_name
from recalib.files.archives import MOST, archive_of, opened, refused
from recalib.files.outputs import AnyPath
from recalib.files.storage import path_of, read_file, whole
from recalib.identification.calibration import Calibration
from recalib.identification.checks.postures import outside_of
from recalib.identification.model.error_model import by_sight
from recalib.identification.model.linearisation import LEVER
from recalib.laboratory.reaching import Goals, NotReached, poses_at, reach_all
from recalib.nominal.arms import arm_of
from recalib.nominal.kinematics import Arm
from recalib.nominal.workspace import orientation_error
from recalib.spelling import counted, listed

FORMAT, WRITER = ("recalib correction", 4), "recalib calibrate"
NAME = "correction.npz"  # of the file in the folder of a calibration
BASE, INSTRUMENT = FRAMES = "base", "instrument"  # of desired poses
NEAR = 0.05  # m between a desired pose and the arm's pose at the joints given with it
BETTER = 0.1  # the fraction of this distance that remains if the poses are in the other frame
STEP = np.pi / 2  # rad: a larger turn from the last command would swing the arm
MARGIN = 0.05  # at either end of the measured range, as a fraction of this range


@dataclass(frozen=True)
class Commands:
    """Commands to send to the controller.

    Attributes:
        joints: (n, columns) rad, or m for sliding joints, for the controller to go to.
        poses: (n, 4, 4) m of the nominal tool in the base at these joints: the fake poses.
        beyond: (n, columns) rad, or m for sliding joints, distance outside the measured range;
            zero within a margin of a twentieth of this range.
        turned: (n,) rad, error of the reached rotation if the arm has fewer than six joints.
        outside: (n, 2) m and rad, distance of each desired pose from the measured poses.
    """

    joints: np.ndarray
    poses: np.ndarray
    beyond: np.ndarray
    turned: np.ndarray
    outside: np.ndarray


@dataclass(frozen=True)
class Correction:
    """A calibrated arm that corrects commands, and the postures in which it was measured.

    Attributes:
        urdf: content of the nominal arm's file, as the user gave it; empty without a file.
        calibration: the identified errors of the arm, and the frames.
        learned: (n, joints) rad, or m for sliding joints, of the measured postures.
        targets: names of the targets, in the order of their numbers.
    """

    urdf: bytes
    calibration: Calibration
    learned: np.ndarray
    targets: tuple[str, ...] = ("the target",)

    @property
    def arm(self) -> Arm:
        """The nominal arm."""
        return self.calibration.model.nominal

    def correct(
        self,
        poses: ArrayLike,
        near: ArrayLike | None = None,
        target: str | Sequence[str] | None = None,
        frame: str | None = None,
    ) -> Commands:
        """Commands that take the real arm to desired poses.

        An arm of fewer than six joints reaches the position, with the rotation as near as
        possible.

        Args:
            poses: (n, 4, 4), or positions (n, 3) [m], of targets in the instrument's frame, or of
                the tool link in the arm's base; a single pose or position is allowed.
            near: (n, columns) rad, m: postures to stay near to, as the controller reports them.
            target: the name of the target, or a name for each pose; needed with several targets.
            frame: instrument or base (default: instrument; base if balls in sockets were measured).

        Raises NotReached; InvalidSetting: another shape, a frame that is not identifiable, or one
        that contradicts the given joints; UnknownName: an unknown frame or target.
        """
        goals = self._goals(poses, near, target, frame)
        self._check_frame(goals)
        found = reach_all(self.calibration, self.postures, goals)
        turned = np.zeros(len(found))
        if goals.poses.ndim == 3:
            reached = poses_at(self.calibration, found, goals.targets)
            turned = orientation_error(reached, goals.poses)
        low, high = self.postures.min(axis=0), self.postures.max(axis=0)
        outside = np.maximum(low - found, found - high)
        beyond = np.where(outside > MARGIN * (high - low), outside, 0.0)
        fake = self.arm.forward(self.arm.coupling.joints(found))
        return Commands(found, fake, beyond, turned, self._outside(goals))

    def command(
        self,
        pose: ArrayLike,
        near: ArrayLike | None,
        target: str | None = None,
        frame: str | None = None,
    ) -> np.ndarray:
        """The joint coordinates (joints,) [rad, m] to send, fast enough for a controller's loop.

        Args:
            pose: (4, 4), or a position (3,) [m] if the rotation is free.
            near: (joints,) rad, m, such as the last command: the solution stays on its branch. If
                None, the measured postures nearest to the pose are the starts, and no turn is
                refused.
            target, frame: see `correct`.

        Raises like `correct`, and NotReached if a joint would turn by more than 90 degrees from
        `near`, or slide by more than 785 mm, as can happen at a singularity.
        """
        goals = self._goals(pose, near, target, frame)
        if len(goals) != 1:
            raise InvalidSetting("pose", counted(len(goals), "pose"), "one; try: correct")
        (found,) = reach_all(self.calibration, self.postures, goals)
        start, coupling = found if goals.postures is None else goals.postures[0], self.arm.coupling
        turns = np.abs(found - start) / np.where(coupling.slides, LEVER, 1.0)
        if (far := turns > STEP).any():
            names = listed(np.array(coupling.columns)[far], "and")
            farthest = f"90 deg, or {1e3 * LEVER * STEP:.0f} mm if prismatic,"
            raise NotReached([1], f"only with {names} more than {farthest} from the given posture")
        return found

    @cached_property
    def postures(self) -> np.ndarray:
        """The measured postures (n, columns) [rad, m], as the controller reports them."""
        return self.arm.coupling.reported(self.learned)

    @property
    def base_known(self) -> bool:
        """Whether the measurements determine the pose of the arm's base."""
        frames = self.calibration.frames
        return not frames.base_unknown or bool(len(frames.sockets))

    @property
    def unidentifiable_ends(self) -> str | None:
        """The ends of the arm whose errors are not identifiable, in words."""
        frames = self.calibration.frames
        positions_alone = len(self.calibration.estimate.noise) == 1
        ends = {
            "the arm's base": frames.base_unknown or len(frames.sockets),
            "the tool link": frames.targets_unknown,
            "the rotation of the tool link": positions_alone and not frames.targets_unknown,
        }
        return " and ".join(end for end, unknown in ends.items() if unknown) or None

    def archive(self) -> bytes:
        """The content of the file. Raises InvalidSetting without a URDF."""
        if not self.urdf:
            valid = "the arm's file; try: calibrate_arm, whose result can be saved"
            raise InvalidSetting("urdf", None, valid)
        form, version = FORMAT
        arm = {"tool": self.arm.tool, "base": self.arm.base, "targets": self.targets}
        header = {"format": form, "version": version, **arm}
        urdf = np.frombuffer(self.urdf, dtype=np.uint8)  # in any encoding
        state = {"urdf": urdf, "learned": self.learned, "calibration": self.calibration.state()}
        return archive_of(header, state)

    def save(self, path: AnyPath) -> None:
        """Write the file completely or not at all."""
        with whole(path) as temporary:
            temporary.write_bytes(self.archive())

    @classmethod
    def from_archive(cls, content: bytes, path: Path) -> "Correction":
        """Restore what `archive` returned; messages name the path. Raises InvalidFile."""
        header, state = opened(content, path, FORMAT, WRITER)
        with refused(path, WRITER):
            urdf = state["urdf"].tobytes()
            arm = arm_of(urdf, path, header["tool"], header["base"])
            calibration = Calibration.restore(arm, state["calibration"])
            loaded = cls(urdf, calibration, state["learned"], tuple(header["targets"]))
            if not loaded._is_consistent():
                raise ValueError
        return loaded

    def _goals(
        self,
        poses: ArrayLike,
        near: ArrayLike | None,
        target: str | Sequence[str] | None,
        frame: str | None,
    ) -> Goals:
        """The poses with the numbers of their targets. Raises like `correct`."""
        goals = Goals.of(poses, near, self.arm.coupling)
        frames, kinds = self.calibration.frames, len(self.calibration.estimate.noise)
        if frame is None:
            frame = BASE if len(frames.sockets) else INSTRUMENT
        check_name("frame", frame, FRAMES)
        if frame == BASE:
            if target is not None:
                raise InvalidSetting("frame", frame, "instrument, the frame of a target's poses")
            if not self.base_known:
                raise InvalidSetting(
                    "frame",
                    frame,
                    "instrument, because the arm's base is not identifiable from the measurements;"
                    " try: a calibration with [instrument] in its description",
                )
            return goals
        if len(frames.sockets):
            raise InvalidSetting("frame", frame, "base: balls in sockets need no instrument")
        if goals.poses.ndim == 3 and frames.targets_unknown and kinds == 1:
            valid = "positions alone: measured positions do not determine a target's rotation"
            raise InvalidSetting("rotations of a target", "given", valid)
        target = target.ravel().tolist() if isinstance(target, np.ndarray) else target
        check_kind("target", target, str, Iterable, type(None))
        if target is None and len(self.targets) > 1:
            raise InvalidSetting("target", None, f"{listed(self.targets, 'or')} for each pose")
        given = self.targets if target is None else target
        names = [given] if isinstance(given, str) else [*given]
        for name in names:
            check_name("target", name, self.targets)
        if len(names) not in (1, len(goals)):
            raise InvalidSetting("target", f"{len(names)} names", f"one, or {len(goals)}")
        numbers = np.array([self.targets.index(name) for name in names])
        return replace(goals, targets=np.resize(numbers, len(goals)))

    def _outside(self, goals: Goals) -> np.ndarray:
        """Distances (n, 2) [m, rad] of goals from the measured poses."""
        far = np.zeros((len(goals), 2))
        for target, rows in by_sight(goals.targets, len(goals)):
            number = None if goals.targets is None else target
            known = poses_at(self.calibration, self.postures, number)
            far[rows] = outside_of(known, goals.poses[rows])
        return far

    def _check_frame(self, goals: Goals) -> None:
        """Raise InvalidSetting if the given joints reach the poses only in the other frame."""
        postures, places = goals.postures, goals.positions
        if postures is None or len(self.targets) > 1 or len(self.calibration.frames.sockets):
            return
        frame, other = (BASE, INSTRUMENT) if goals.targets is None else (INSTRUMENT, BASE)
        gaps = {}
        for name, target in ((BASE, None), (INSTRUMENT, 0)):
            off = poses_at(self.calibration, postures, target)[:, :3, 3] - places
            gaps[name] = np.median(np.linalg.norm(off, axis=1))
        if gaps[other] < min(NEAR, BETTER * gaps[frame]) and gaps[frame] > NEAR:
            raise InvalidSetting(
                "frame",
                frame,
                f"{other}, because the joints reach the poses there; in the given frame they are"
                f" {1e3 * gaps[frame]:.0f} mm off; try: omit the joints if they only select a"
                " posture",
            )

    def _is_consistent(self) -> bool:
        """Whether the parts of a file belong together; any exception means that they do not."""
        calibration, learned = self.calibration, self.learned
        estimate, frames = calibration.estimate, calibration.model.frames
        sights, ends = frames.sights, (len(frames.bases), len(frames.targets))
        if not len(sights) or sights.dtype != int or ((sights < 0) | (sights >= ends)).any():
            return False
        if len({*map(str, self.targets)}) != len(sights):
            return False
        unknown = estimate.parameters @ estimate.covariance @ estimate.parameters
        estimated = estimate.parameters, estimate.covariance, estimate.noise, estimate.weights
        numbers = learned, *calibration.forward_and_jacobian(learned[:1]), unknown, *estimated
        return learned.shape[1:] == (len(self.arm.joints),) and all(
            array.size and array.dtype == float and np.isfinite(array).all() for array in numbers
        )


def load_correction(path: AnyPath) -> Correction:
    """The calibrated arm in a file, or in a folder from `recalib calibrate`. Raises InvalidFile."""
    file = path_of(path) if os.path.isfile(path_of(path)) else Path(path, NAME)
    return Correction.from_archive(read_file(file, MOST), file)
