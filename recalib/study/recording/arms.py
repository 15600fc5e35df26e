"""The two arms of a learner: the real one, and a skeleton of the one its controller assumes."""

from collections.abc import Sequence

import numpy as np
import pinocchio as pin
import rerun as rr

from recalib.damaged.damage import Damage, apply
from recalib.errors import InvalidFile
from recalib.files.storage import read_file
from recalib.laboratory.viewing import link_placements, log_meshes, send_frame
from recalib.nominal.descriptions import MOST
from recalib.nominal.robots import Robot
from recalib.study.recording.colours import BELIEVED, SHORT, WRONG
from recalib.study.recording.markers import base_shift, circle, markers
from recalib.study.recording.scene import Scene, unit_of

BONE, JOINT = 0.045, 0.075  # radii of the skeleton, in units of `unit_of`
FOOT = 0.7  # radius of the circle about a base that was moved, in these units


def send_arms(scene: Scene, robot: Robot, damages: Sequence[Damage]) -> None:
    """Both arms in motion, and what is wrong with the real one.

    They move on `time` throughout, on `moves` while the arm learns.
    Raises InvalidFile where a mesh of the robot is not found.
    """
    rec, learner, motion = scene.rec, scene.learner, scene.motion
    damaged, base = apply(robot, damages), base_shift(robot, damages)
    source = read_file(robot.urdf, MOST)
    visuals, missing = log_meshes(rec, source, robot.urdf, learner)
    if missing:
        raise InvalidFile(robot.urdf, f"mesh {missing[0]!r} is in none of its packages and folders")
    for clock, angles in (
        (motion.visits(), motion.angles),
        (motion.measurements(), scene.watched.angles[:, -1]),
    ):
        standing = damaged.standing(angles)
        for link, placements in link_placements(damaged.arm, visuals, standing, base).items():
            send_frame(rec, f"{learner}/links/{link}", f"{learner}/{link}", clock, placements)
        bones = robot.arm.skeleton(angles)
        joints = rr.Points3D.columns(positions=bones.reshape(-1, 3))
        scene.send("believed/joints", clock, joints, bones.shape[1])
        scene.send("believed/bones", clock, rr.LineStrips3D.columns(strips=bones))
    unit = unit_of(scene.workspace)
    bones = rr.LineStrips3D.from_fields(colors=BELIEVED, radii=BONE * unit)
    scene.log("believed/bones", bones)
    scene.log("believed/joints", rr.Points3D.from_fields(colors=BELIEVED, radii=JOINT * unit))
    _log_markers(scene, robot, damages, visuals)
    if not base.isIdentity():
        _log_base(scene, base)


def _log_markers(
    scene: Scene, robot: Robot, damages: Sequence[Damage], visuals: dict[str, list[str]]
) -> None:
    """Words at every link and joint with which something is wrong, and the axes of the joints."""
    unit = unit_of(scene.workspace)
    for number, marker in enumerate(markers(robot, damages, unit)):
        entity, frame = f"wrong/{number}", rr.CoordinateFrame(f"{scene.learner}/{marker.link}")
        if marker.words:
            words = rr.Points3D([marker.at], radii=0, colors=WRONG, labels=[marker.words])
            scene.log(entity, words, frame)
        if marker.axis is not None:
            axis = rr.LineStrips3D([marker.axis], radii=BONE * unit / 2, colors=WRONG)
            scene.log(f"{entity}/axis", axis, frame)
            continue
        for mesh in visuals.get(marker.link, ()):
            scene.rec.log(mesh, rr.Asset3D.from_fields(albedo_factor=SHORT), static=True)


def _log_base(scene: Scene, base: pin.SE3) -> None:
    """Where the base is believed to stand, and where it stands."""
    unit = unit_of(scene.workspace)
    for name, placement, colour in (
        ("believed", pin.SE3.Identity(), BELIEVED),
        ("wrong", base, WRONG),
    ):
        strips = [circle(placement, FOOT * unit)]
        line = rr.LineStrips3D(strips, radii=BONE * unit / 2, colors=colour)
        scene.log(f"{name}/base", line)
    far, turned = np.linalg.norm(base.translation), np.linalg.norm(pin.log3(base.rotation))
    words = [f"moved {100 * far:.1f} cm"] if far else []
    words += [f"turned {np.degrees(turned):.1f}°"] if turned else []
    label = rr.Points3D([base.translation], radii=0, colors=WRONG, labels=[" and ".join(words)])
    scene.log("wrong/base/words", label)
