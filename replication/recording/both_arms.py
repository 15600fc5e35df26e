"""The two arms of a learner: the real arm, and a skeleton of the arm its controller assumes."""

from collections.abc import Sequence

import numpy as np
import pinocchio as pin
import rerun as rr

from recalib.damaged.damage import BaseShift, Damage, apply
from recalib.errors import InvalidFile
from recalib.files.storage import read_file
from recalib.laboratory.logged_arm import link_placements, log_meshes, send_frame
from recalib.nominal.descriptions import MOST
from replication.config.damages import joint_of, link_of
from replication.recording.colours import DAMAGE, NOMINAL
from replication.recording.phases import CLOCK
from replication.recording.scene import ASSUMED, REAL, Scene, send_gripper

BONE, JOINT = 0.045, 0.075  # radii of the skeleton, in units of `Scene.unit`
FOOT = 0.7  # radius of the circle about a displaced base
AXIS = 0.5  # half the length of the line along the axis of a damaged joint


def send_arms(scene: Scene, damages: Sequence[Damage]) -> None:
    """Send both arms in motion, each with its gripper, and mark the real arm's damage.

    Raises InvalidFile if a mesh of the robot is not found.
    """
    rec, learner, robot = scene.rec, scene.learner, scene.robot
    motion, unit = scene.motion, scene.unit
    damaged, first = apply(robot, damages), robot.arm.model.jointPlacements[1]
    shifted = apply(robot, [damage for damage in damages if isinstance(damage, BaseShift)])
    base = shifted.arm.model.jointPlacements[1] * first.inverse()  # in the nominal base frame
    source = read_file(robot.urdf, MOST)
    visuals, missing = log_meshes(rec, source, robot.urdf, learner)
    if missing:
        raise InvalidFile(robot.urdf, f"mesh {missing[0]!r} is in none of its packages and folders")
    clock = [rr.TimeColumn(CLOCK, sequence=motion.frames)]
    standing = damaged.standing(motion.angles)
    moved = {number: link for link, number in robot.links.items()}  # by the joint that moves them
    damaged_joints = {joint: robot.joints.index(joint) for joint in map(joint_of, damages) if joint}
    links = dict.fromkeys([*visuals, *(moved[1 + index] for index in damaged_joints.values())])
    for link, poses in link_placements(damaged.arm, links, standing, base).items():
        send_frame(rec, f"{learner}/links/{link}", f"{learner}/{link}", clock, poses)
    reached, assumed = damaged.arm.forward(standing), robot.arm.forward(motion.angles)
    send_gripper(scene, "tool", clock, reached, REAL)
    send_gripper(scene, "nominal/tool", clock, assumed, ASSUMED)
    bones = robot.arm.skeleton(motion.angles)
    joints = rr.Points3D.columns(positions=bones.reshape(-1, 3))
    scene.send("nominal/joints", clock, joints, bones.shape[1])
    scene.send("nominal/bones", clock, rr.LineStrips3D.columns(strips=bones))
    scene.log("nominal/bones", rr.LineStrips3D.from_fields(colors=NOMINAL, radii=BONE * unit))
    scene.log("nominal/joints", rr.Points3D.from_fields(colors=NOMINAL, radii=JOINT * unit))
    for link in map(link_of, damages):
        for mesh in visuals.get(link, ()):
            rec.log(mesh, rr.Asset3D.from_fields(albedo_factor=DAMAGE), static=True)
    for joint, index in damaged_joints.items():
        reach = AXIS * unit * robot.arm.axes[index]
        axis = rr.LineStrips3D([[-reach, reach]], radii=BONE * unit / 2, colors=DAMAGE)
        scene.log(f"damage/{joint}", axis, rr.CoordinateFrame(f"{learner}/{moved[1 + index]}"))
    if not base.isIdentity():
        for name, at, colour in (
            ("nominal", pin.SE3.Identity(), NOMINAL),
            ("damage", base, DAMAGE),
        ):
            strips = [circle(at, FOOT * unit)]
            scene.log(f"{name}/base", rr.LineStrips3D(strips, radii=BONE * unit / 2, colors=colour))


def circle(placement: pin.SE3, radius: float) -> np.ndarray:
    """A circle (point, 3) [m] about the z axis of a placement."""
    angles = np.linspace(0, 2 * np.pi, 49)
    flat = radius * np.stack([np.cos(angles), np.sin(angles), np.zeros_like(angles)], axis=1)
    return flat @ placement.rotation.T + placement.translation
