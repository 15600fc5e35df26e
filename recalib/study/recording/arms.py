"""The two arms: the real one where it is, and the nominal one where the controller believes it."""

import os
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pinocchio as pin
import rerun as rr
from rerun.urdf import UrdfTree
from scipy.spatial.transform import Rotation

from recalib.damaged.damage import BaseShift, Damage, apply
from recalib.nominal.kinematics import Arm
from recalib.nominal.robots import Robot
from recalib.study.recording.story import Motion, Watched

GHOST = (140, 190, 255, 70)
WORLD = "tf#/"  # the frame that Rerun gives to the root of the entities


def send_arms(
    rec: rr.RecordingStream,
    robot: Robot,
    damages: Sequence[Damage],
    watched: Watched,
    motion: Motion,
) -> None:
    """The meshes of both arms, and every link's motion.

    It goes on `time` throughout, on `iteration` while the arm learns.
    """
    damaged = apply(robot, damages)
    shifts = apply(robot, [damage for damage in damages if isinstance(damage, BaseShift)])
    base = shifts.arm.model.jointPlacements[1] * robot.arm.model.jointPlacements[1].inverse()
    acts = [rr.TimeColumn("time", duration=motion.times)]
    iterations = rr.TimeColumn("iteration", sequence=watched.history.iterations)
    learning = [iterations, rr.TimeColumn("time", duration=motion.learning)]
    for name, arm, shift, standing, tint in (
        ("damaged", damaged.arm, base, damaged.standing, None),
        ("nominal", robot.arm, pin.SE3.Identity(), np.asarray, GHOST),
    ):
        links = _log_meshes(rec, robot.urdf, name, tint)
        for clock, angles in ((acts, motion.angles), (learning, watched.angles[:, -1])):
            for link, placements in link_placements(arm, links, standing(angles), shift).items():
                rec.send_columns(
                    f"{name}/{link}",
                    clock,
                    rr.Transform3D.columns(
                        translation=placements[:, :3, 3],
                        quaternion=Rotation.from_matrix(placements[:, :3, :3]).as_quat(),
                        parent_frame=[WORLD] * len(placements),
                        child_frame=[f"{name}/{link}"] * len(placements),
                    ),
                )


def link_placements(
    arm: Arm, links: Iterable[str], angles: np.ndarray, base: pin.SE3
) -> dict[str, np.ndarray]:
    """Placements (n, 4, 4) [m] of links in the world at joint angles (n, 6) [rad].

    Args:
        base: how the robot's base was shifted. The arm's joints know of it, the links before the
            first joint do not.
    """
    model, data = arm.model, arm.model.createData()
    frames = {link: model.getFrameId(link, pin.FrameType.BODY) for link in links}
    placements = {link: np.empty((len(angles), 4, 4)) for link in frames}
    for index, q in enumerate(angles):
        pin.framesForwardKinematics(model, data, q)
        for link, frame in frames.items():
            placement = (
                data.oMf[frame] if model.frames[frame].parentJoint else base * data.oMf[frame]
            )
            placements[link][index] = placement.homogeneous
    return placements


def _log_meshes(
    rec: rr.RecordingStream, urdf: Path, arm: str, tint: tuple[int, ...] | None
) -> list[str]:
    """Log the visual meshes of a robot, each in the frame `<arm>/<link>` of its link.

    Returns these links.
    """
    tree = UrdfTree.from_file_path(urdf, entity_path_prefix=arm, frame_prefix=f"{arm}/")
    links = [tree.root_link(), *(tree.get_joint_child(joint) for joint in tree.joints())]
    visuals = {
        link.name: paths for link in links if (paths := tree.get_visual_geometry_paths(link))
    }
    entities = [entity for paths in visuals.values() for entity in paths]
    with _packages(urdf):
        rec.send_chunks(tree.stream(include_joint_transforms=False).filter(content=entities))
    if tint:
        for entity in entities:
            rec.log(entity, rr.Asset3D.from_fields(albedo_factor=tint), static=True)
    return list(visuals)


@contextmanager
def _packages(urdf: Path) -> Iterator[None]:
    """Let the meshes be found, `package://NAME/...`: NAME is a folder beside or above the URDF.

    Rerun looks for packages in this variable.
    """
    variable = "ROS_PACKAGE_PATH"
    before = os.environ.get(variable)
    folders = [*map(str, urdf.parents), *([before] if before else [])]
    os.environ[variable] = os.pathsep.join(folders)
    try:
        yield
    finally:
        del os.environ[variable]
        if before is not None:
            os.environ[variable] = before
