"""The two arms of a learner: the real one, and as a skeleton the one its controller believes in."""

from collections.abc import Sequence

import numpy as np
import pinocchio as pin
import rerun as rr

from recalib.damaged.damage import Damage, apply
from recalib.errors import InvalidFile
from recalib.nominal.descriptions import MOST
from recalib.nominal.robots import Robot
from recalib.storage import read_file
from recalib.study.recording.clocks import clocks
from recalib.study.recording.colours import BELIEVED, SHORT, WRONG
from recalib.study.recording.marks import Mark, base_shift, circle, marks
from recalib.study.recording.scene import unit_of
from recalib.study.recording.story import Motion, Watched
from recalib.viewing import link_placements, log_meshes, send_frame

BONE, JOINT = 0.045, 0.075  # radii of the skeleton, in units of `unit_of`
FOOT = 0.7  # radius of the circle about a base that was moved, in these units


def send_arms(
    rec: rr.RecordingStream,
    robot: Robot,
    damages: Sequence[Damage],
    learner: str,
    watched: Watched,
    motion: Motion,
) -> None:
    """Both arms in motion, and what is wrong with the real one.

    They move on `time` throughout, on `moves` while the arm learns.
    """
    damaged, base = apply(robot, damages), base_shift(robot, damages)
    unit = unit_of(robot.workspace)
    wrong = marks(robot, damages, unit)
    short = [mark.link for mark in wrong if mark.axis is None]
    source = read_file(robot.urdf, MOST)
    visuals, missing = log_meshes(rec, source, robot.urdf, learner)
    if missing:
        raise InvalidFile(robot.urdf, f"mesh {missing[0]!r} is in none of its packages and folders")
    for entity in (entity for link in short for entity in visuals.get(link, ())):
        rec.log(entity, rr.Asset3D.from_fields(albedo_factor=SHORT), static=True)
    acts, learning = clocks(watched, motion)
    for clock, angles in ((acts, motion.angles), (learning, watched.angles[:, -1])):
        standing = damaged.standing(angles)
        for link, placements in link_placements(damaged.arm, visuals, standing, base).items():
            send_frame(rec, f"{learner}/links/{link}", f"{learner}/{link}", clock, placements)
        bones = robot.arm.skeleton(angles)
        each = [bones.shape[1]] * len(bones)
        joints = rr.Points3D.columns(positions=bones.reshape(-1, 3)).partition(each)
        rec.send_columns(f"{learner}/believed/joints", clock, joints)
        lines = rr.LineStrips3D.columns(strips=bones).partition([1] * len(bones))
        rec.send_columns(f"{learner}/believed/bones", clock, lines)
    looks = (("bones", rr.LineStrips3D, BONE), ("joints", rr.Points3D, JOINT))
    for part, shape, radius in looks:
        look = shape.from_fields(colors=BELIEVED, radii=radius * unit)
        rec.log(f"{learner}/believed/{part}", look, static=True)
    _log_marks(rec, learner, wrong, unit)
    if not base.isIdentity():
        _log_base(rec, learner, base, unit)


def _log_marks(rec: rr.RecordingStream, learner: str, wrong: Sequence[Mark], unit: float) -> None:
    """Words at every link and joint with which something is wrong, and the axes of the joints."""
    for number, mark in enumerate(wrong):
        entity, frame = f"{learner}/wrong/{number}", rr.CoordinateFrame(f"{learner}/{mark.link}")
        if mark.words:
            words = rr.Points3D([mark.at], radii=0, colors=WRONG, labels=[mark.words])
            rec.log(entity, words, frame, static=True)
        if mark.axis is not None:
            axis = rr.LineStrips3D([mark.axis], radii=BONE * unit / 2, colors=WRONG)
            rec.log(f"{entity}/axis", axis, frame, static=True)


def _log_base(rec: rr.RecordingStream, learner: str, base: pin.SE3, unit: float) -> None:
    """Where the base is believed to stand, and where it stands."""
    radius = FOOT * unit
    for name, placement, colour in (
        ("believed", pin.SE3.Identity(), BELIEVED),
        ("wrong", base, WRONG),
    ):
        line = rr.LineStrips3D([circle(placement, radius)], radii=BONE * unit / 2, colors=colour)
        rec.log(f"{learner}/{name}/base", line, static=True)
    far, turned = np.linalg.norm(base.translation), np.linalg.norm(pin.log3(base.rotation))
    words = [f"moved {100 * far:.1f} cm"] if far else []
    words += [f"turned {np.degrees(turned):.1f}°"] if turned else []
    label = rr.Points3D([base.translation], radii=0, colors=WRONG, labels=[" and ".join(words)])
    rec.log(f"{learner}/wrong/base/words", label, static=True)
