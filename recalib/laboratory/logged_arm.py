"""An arm in the Rerun viewer: the meshes and the poses of its links."""

from collections.abc import Iterable
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pinocchio as pin
import rerun as rr
from rerun.urdf import UrdfTree
from scipy.spatial.transform import Rotation

from recalib.nominal.kinematics import Arm
from recalib.nominal.meshes import with_own_meshes

WORLD = "tf#/"  # Rerun's frame of the root entity
ARM, ROW = "arm", "row"
THICK, GREY = 0.003, (120, 120, 120)  # m


def log_meshes(
    rec: rr.RecordingStream, source: bytes, urdf: Path, prefix: str
) -> tuple[dict[str, list[str]], list[str]]:
    """Log the visual meshes of a URDF, given its content, in the links' frames `<prefix>/<link>`.

    Returns the entities of each link that has any, and the names of the meshes that are in none of
    the URDF's packages and folders.
    """
    text, missing = with_own_meshes(source, urdf)
    with TemporaryDirectory() as folder:
        file = Path(folder, "arm.urdf")
        file.write_bytes(text)
        tree = UrdfTree.from_file_path(file, entity_path_prefix=prefix, frame_prefix=f"{prefix}/")
        links = [tree.root_link(), *(tree.get_joint_child(joint) for joint in tree.joints())]
        visuals = {
            link.name: paths for link in links if (paths := tree.get_visual_geometry_paths(link))
        }
        entities = [entity for paths in visuals.values() for entity in paths]
        rec.send_chunks(tree.stream(include_joint_transforms=False).filter(content=entities))
    return visuals, missing


def send_frame(
    rec: rr.RecordingStream, entity: str, frame: str, clock: list[rr.TimeColumn], poses: np.ndarray
) -> None:
    """Send the poses (n, 4, 4) [m] of a frame in the world, at the times of the clock."""
    transforms = rr.Transform3D.columns(
        translation=poses[:, :3, 3],
        quaternion=Rotation.from_matrix(poses[:, :3, :3]).as_quat(),
        parent_frame=[WORLD] * len(poses),
        child_frame=[frame] * len(poses),
    )
    rec.send_columns(entity, clock, transforms)


def send_arm(
    rec: rr.RecordingStream,
    arm: Arm,
    visuals: Iterable[str],
    clock: list[rr.TimeColumn],
    joints: np.ndarray,
) -> None:
    """Send the poses of links from `log_meshes` at joints (n, joints) [rad, m].

    Also sends a line along the arm, which shows the arm even if meshes are missing.
    """
    for link, poses in link_placements(arm, visuals, joints).items():
        send_frame(rec, f"{ARM}/{link}", f"{ARM}/{link}", clock, poses)
    lines = rr.LineStrips3D.columns(
        strips=[[line] for line in arm.skeleton(joints).tolist()],
        radii=[THICK] * len(joints),
        colors=[GREY] * len(joints),
    )
    rec.send_columns("line", clock, lines)


def link_placements(
    arm: Arm, links: Iterable[str], angles: np.ndarray, base: pin.SE3 | None = None
) -> dict[str, np.ndarray]:
    """Placements (n, 4, 4) [m] of links in the world at joint angles (n, joint) [rad].

    The arm's joints already include a shift of the robot's base; links before the first joint do
    not, and are shifted by `base`.
    """
    model, data, base = arm.model, arm.model.createData(), base or pin.SE3.Identity()
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
