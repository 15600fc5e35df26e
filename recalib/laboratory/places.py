"""The identified poses of instruments, targets and sockets, and their uncertainty.

The uncertainty is given relative to the calibrated arm and relative to the real one. No measurement
distinguishes an offset of the first joint from a rotation of the instrument about that joint's
axis. The calibrated arm is one of the solutions that fit. Relative to it, the instrument's pose is
as certain as the measurements; relative to the real base, it is as uncertain as the offset's prior.
"""

import shlex
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.identification.calibration import Calibration
from recalib.identification.checks.identifiability import Unidentifiable
from recalib.identification.model.error_model import ErrorModel
from recalib.identification.model.frames import HELD, Frames
from recalib.identification.model.hand_eye_model import HandEye, worst_axes
from recalib.identification.model.linearisation import displacements
from recalib.laboratory.data_set import DataSet
from recalib.laboratory.urdf.origins import angles_of

STEP = 1e-4  # of central differences, as a fraction of a parameter's prior deviation


@dataclass(frozen=True)
class Place:
    """The identified pose of an instrument, a target or a socket.

    Deviations are standard deviations [m, rad] along the worst axis.
    """

    name: str  # such as "the instrument"
    link: str  # the link in whose frame the pose is given
    turned: bool  # whether the rotation is identified
    pose: np.ndarray  # (4, 4) m
    deviations: tuple[float, float]  # relative to the calibrated arm
    real_deviations: tuple[float, float]  # relative to the real arm

    @property
    def position(self) -> np.ndarray:
        """(3,) m."""
        return self.pose[:3, 3]

    @property
    def degrees(self) -> np.ndarray:
        """Roll, pitch and yaw (3,) [deg], as in a URDF."""
        return np.degrees(angles_of(self.pose))

    @property
    def rotation(self) -> Rotation:
        return Rotation.from_matrix(self.pose[:3, :3])

    @property
    def frame(self) -> str:
        """The name in the spelling of TOML keys and ROS frames."""
        return self.name.removeprefix("the ").replace(" ", "_")

    @property
    def ros(self) -> str:
        """The ROS 2 command that publishes this pose."""
        names = "x", "y", "z", "qx", "qy", "qz", "qw"
        numbers = zip(names, [*self.position, *self.rotation.as_quat(canonical=True)], strict=True)
        given = " ".join(f"--{name} {number:.7f}" for name, number in numbers)
        frames = f"--frame-id {shlex.quote(self.link)} --child-frame-id {self.frame}"
        return f"ros2 run tf2_ros static_transform_publisher {given} {frames}"

    @property
    def urdf(self) -> str:
        """The pose as a fixed joint."""
        ends = self.position, np.radians(self.degrees)
        xyz, rpy = (" ".join(f"{number:.7f}" for number in numbers) for numbers in ends)
        return (
            f'<joint name="{self.frame}_joint" type="fixed"><origin xyz="{xyz}" rpy="{rpy}"/>'
            f'<parent link="{self.link}"/><child link="{self.frame}"/></joint>'
        )


def found_places(
    calibration: Calibration, unidentifiable: Sequence[Unidentifiable], data: DataSet, tool: str
) -> list[Place]:
    """The identified places.

    Args:
        unidentifiable: see `unidentifiable_parameters`.
        data: names the instruments, targets and sockets.
        tool: the tool link of the calibrated arm.
    """
    model, estimate = calibration.model, calibration.estimate
    frames, base, free = model.frames, model.nominal.base, np.flatnonzero(model.free)
    turned = frames.target_deviations[1] > HELD
    what = [(name, base, True) for name in data.instruments] * _has_instrument(frames)
    what += [(name, tool, turned) for name in data.target_names] * frames.targets_unknown
    what += [(f"socket {name}", base, False) for name in data.sockets]
    if not what:
        return []
    lasting = np.array([one.parameter for one in unidentifiable if one.lasting], dtype=int)
    fixed = np.setdiff1d(lasting, free)
    real = estimate.covariance[np.ix_(free, free)]
    across = estimate.covariance[np.ix_(free, fixed)]
    among = estimate.covariance[np.ix_(fixed, fixed)]
    conditional = real - across @ np.linalg.solve(among, across.T)
    slopes = _slopes(model, estimate.parameters, free)
    poses = _poses(model, estimate.parameters)
    return [
        Place(*one, pose, *(worst_axes(slope @ cov @ slope.T) for cov in (conditional, real)))
        for one, pose, slope in zip(what, poses, slopes, strict=True)
    ]


def hand_eye_places(found: HandEye, names: Sequence[str], links: Sequence[str]) -> list[Place]:
    """The places of camera and board from a hand-eye calibration, in the frames of two links."""
    pairs = zip(names, links, (found.camera, found.board), strict=True)
    return [
        Place(name, link, True, pose, *[found.deviations(part)] * 2)
        for part, (name, link, pose) in enumerate(pairs)
    ]


def _has_instrument(frames: Frames) -> bool:
    """Whether the instrument's pose is identified; a ball in sockets needs no instrument."""
    return frames.base_unknown and not len(frames.sockets)


def _poses(model: ErrorModel, parameters: np.ndarray) -> np.ndarray:
    """Poses (place, 4, 4) [m] of all instruments, targets and sockets that were not given."""
    frames = model.found(parameters)
    poses = [*np.linalg.inv(frames.bases)] * _has_instrument(frames)
    poses += [*frames.targets] * frames.targets_unknown
    for centre in frames.sockets:
        poses.append(np.eye(4))
        poses[-1][:3, 3] = centre
    return np.array(poses)


def _slopes(model: ErrorModel, parameters: np.ndarray, free: np.ndarray) -> np.ndarray:
    """Derivatives (place, 6, free) [m, rad] of the places by the free parameters of frames."""
    columns = []
    for number in free:
        step = np.zeros_like(parameters)
        step[number] = STEP * model.deviations[number]
        ends = (_poses(model, parameters + sign * step) for sign in (-1, 1))
        columns.append(displacements(*ends) / (2 * step[number]))
    return np.stack(columns, axis=-1)
