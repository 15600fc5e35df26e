"""The two arms of a learner: the real one, and a skeleton of the one its controller assumes."""

from collections.abc import Sequence

import numpy as np
import pinocchio as pin
import rerun as rr

from recalib.damaged.damage import Damage, apply
from recalib.errors import InvalidFile
from recalib.files.storage import read_file
from recalib.laboratory.viewer.scene import link_placements, log_meshes, send_frame
from recalib.nominal.descriptions import MOST
from recalib.nominal.robots import Robot
from recalib.study.recording.colours import BELIEVED, WRONG
from recalib.study.recording.labels import send_labels
from recalib.study.recording.markers import Marker, base_shift, circle, markers
from recalib.study.recording.scene import Scene, unit_of

BONE, JOINT = 0.045, 0.075  # radii of the skeleton, in units of `unit_of`
FOOT = 0.7  # radius of the circle about a base that was moved, in these units


def send_arms(scene: Scene, robot: Robot, damages: Sequence[Damage]) -> None:
    """Both arms in motion, and what is wrong with the real one.

    Raises InvalidFile where a mesh of the robot is not found.
    """
    rec, learner, motion = scene.rec, scene.learner, scene.motion
    damaged, base = apply(robot, damages), base_shift(robot, damages)
    source = read_file(robot.urdf, MOST)
    visuals, missing = log_meshes(rec, source, robot.urdf, learner)
    if missing:
        raise InvalidFile(robot.urdf, f"mesh {missing[0]!r} is in none of its packages and folders")
    unit, clock = unit_of(scene.workspace), motion.clock()
    standing = damaged.standing(motion.angles)
    found = markers(robot, damages, unit)
    links = dict.fromkeys([*visuals, *(marker.link for marker in found)])
    placements = link_placements(damaged.arm, links, standing, base)
    for link, poses in placements.items():
        send_frame(rec, f"{learner}/links/{link}", f"{learner}/{link}", clock, poses)
    bones = robot.arm.skeleton(motion.angles)
    joints = rr.Points3D.columns(positions=bones.reshape(-1, 3))
    scene.send("believed/joints", clock, joints, bones.shape[1])
    scene.send("believed/bones", clock, rr.LineStrips3D.columns(strips=bones))
    scene.log("believed/bones", rr.LineStrips3D.from_fields(colors=BELIEVED, radii=BONE * unit))
    scene.log("believed/joints", rr.Points3D.from_fields(colors=BELIEVED, radii=JOINT * unit))
    words, starts = [marker.words for marker in found], []
    for number, marker in enumerate(found):
        _log_marker(scene, f"wrong/{number}", marker, visuals)
        starts.append(placements[marker.link][:, :3] @ [*marker.at, 1])
    if not base.isIdentity():
        _log_base(scene, base)
        words.append(_base_words(base))
        starts.append(np.broadcast_to(base.translation, (len(standing), 3)))
    if starts:
        send_labels(scene, words, np.stack(starts))


def _log_marker(scene: Scene, entity: str, marker: Marker, visuals: dict[str, list[str]]) -> None:
    """The axis of a joint, or the colour of a link, with which something is wrong."""
    if marker.axis is not None:
        radius = BONE * unit_of(scene.workspace) / 2
        axis = rr.LineStrips3D([marker.axis], radii=radius, colors=WRONG)
        scene.log(f"{entity}/axis", axis, rr.CoordinateFrame(f"{scene.learner}/{marker.link}"))
        return
    for mesh in visuals.get(marker.link, ()):
        scene.rec.log(mesh, rr.Asset3D.from_fields(albedo_factor=WRONG), static=True)


def _log_base(scene: Scene, base: pin.SE3) -> None:
    """Where the controller assumes the base, and where it stands."""
    unit = unit_of(scene.workspace)
    for name, placement, colour in (
        ("believed", pin.SE3.Identity(), BELIEVED),
        ("wrong", base, WRONG),
    ):
        strips = [circle(placement, FOOT * unit)]
        line = rr.LineStrips3D(strips, radii=BONE * unit / 2, colors=colour)
        scene.log(f"{name}/base", line)


def _base_words(base: pin.SE3) -> str:
    """How far off a base is, in words."""
    far, turned = np.linalg.norm(base.translation), np.linalg.norm(pin.log3(base.rotation))
    words = [f"{100 * far:.1f} cm"] if far else []
    words += [f"{np.degrees(turned):.1f}°"] if turned else []
    return f"base: {' and '.join(words)} off"
