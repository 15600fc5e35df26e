"""The two arms of a learner: the real one, and a skeleton of the one its controller assumes."""

from collections.abc import Sequence

import pinocchio as pin
import rerun as rr

from recalib.damaged.damage import Damage, apply
from recalib.errors import InvalidFile
from recalib.files.storage import read_file
from recalib.laboratory.scene import link_placements, log_meshes, send_frame
from recalib.nominal.descriptions import MOST
from replication.recording.colours import DAMAGE, NOMINAL
from replication.recording.markers import base_shift, circle, markers
from replication.recording.scene import ASSUMED, REAL, Scene, send_gripper

BONE, JOINT = 0.045, 0.075  # radii of the skeleton, in units of `Scene.unit`
FOOT = 0.7  # radius of the circle about a base that was moved


def send_arms(scene: Scene, damages: Sequence[Damage]) -> None:
    """Both arms in motion, each with its gripper, and where the real one is damaged.

    Raises InvalidFile where a mesh of the robot is not found.
    """
    rec, learner, robot = scene.rec, scene.learner, scene.robot
    motion, unit = scene.motion, scene.unit
    damaged, base = apply(robot, damages), base_shift(robot, damages)
    source = read_file(robot.urdf, MOST)
    visuals, missing = log_meshes(rec, source, robot.urdf, learner)
    if missing:
        raise InvalidFile(robot.urdf, f"mesh {missing[0]!r} is in none of its packages and folders")
    clock, standing = motion.clock(), damaged.standing(motion.angles)
    found = markers(robot, damages, unit)
    links = dict.fromkeys([*visuals, *(marker.link for marker in found)])
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
    for marker in found:
        if marker.axis is None:
            for mesh in visuals.get(marker.link, ()):
                rec.log(mesh, rr.Asset3D.from_fields(albedo_factor=DAMAGE), static=True)
        else:
            axis = rr.LineStrips3D([marker.axis], radii=BONE * unit / 2, colors=DAMAGE)
            frame = rr.CoordinateFrame(f"{learner}/{marker.link}")
            scene.log(f"damage/{marker.part}", axis, frame)
    if not base.isIdentity():
        for name, at, colour in (
            ("nominal", pin.SE3.Identity(), NOMINAL),
            ("damage", base, DAMAGE),
        ):
            strips = [circle(at, FOOT * unit)]
            scene.log(f"{name}/base", rr.LineStrips3D(strips, radii=BONE * unit / 2, colors=colour))
