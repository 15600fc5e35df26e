"""A pose in the forms that people paste."""

import shlex
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.laboratory.places import Place


@dataclass(frozen=True)
class Forms:
    """A place, written for ROS 2, URDF, OpenCV and others, in m and rad."""

    place: Place

    @property
    def name(self) -> str:
        """As TOML and ROS take it."""
        return self.place.name.removeprefix("the ").replace(" ", "_")

    @property
    def quaternion(self) -> np.ndarray:
        """x, y, z, w (4,)."""
        return Rotation.from_matrix(self.place.pose[:3, :3]).as_quat(canonical=True)

    @property
    def rotation_vector(self) -> np.ndarray:
        """(3,) rad."""
        return Rotation.from_matrix(self.place.pose[:3, :3]).as_rotvec()

    @property
    def ros(self) -> str:
        """The command of ROS 2 that publishes it."""
        names = "x", "y", "z", "qx", "qy", "qz", "qw"
        numbers = zip(names, np.concatenate([self.place.position, self.quaternion]), strict=True)
        given = " ".join(f"--{name} {number:.7f}" for name, number in numbers)
        frames = f"--frame-id {shlex.quote(self.place.link)} --child-frame-id {self.name}"
        return f"ros2 run tf2_ros static_transform_publisher {given} {frames}"

    @property
    def urdf(self) -> str:
        """A fixed joint."""
        xyz, rpy = (
            " ".join(f"{number:.7f}" for number in numbers)
            for numbers in (self.place.position, np.radians(self.place.degrees))
        )
        return (
            f'<joint name="{self.name}_joint" type="fixed"><origin xyz="{xyz}" rpy="{rpy}"/>'
            f'<parent link="{self.place.link}"/><child link="{self.name}"/></joint>'
        )
