"""All that a laboratory says and writes of synthetic arms, as it is kept in files."""

import csv
import re
from contextlib import suppress
from dataclasses import replace
from io import StringIO
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from recalib.errors import RecalibError
from recalib.identification.observations import Distance, Observations
from recalib.identification.sequence import DRIFT, JUMP, LAG, SLIP, Fault
from recalib.identification.validation import HYBRID, KINDS, RANDOM
from recalib.laboratory import watching
from recalib.laboratory.calibrate import calibrate_arm
from recalib.laboratory.columns import read_table
from recalib.laboratory.command_line import main
from recalib.laboratory.correct import correct, solve, unidentifiable_ends
from recalib.laboratory.correction import load_correction
from recalib.laboratory.description import Description, read_description
from recalib.laboratory.doubts import doubts
from recalib.laboratory.fault_words import in_words
from recalib.laboratory.files import optional_outputs, write_files
from recalib.laboratory.knowledge import check_distances, checked_frames
from recalib.laboratory.links import read_rows, urdf_of
from recalib.laboratory.measurements import Measurements, read_desired, read_measurements
from recalib.laboratory.parameters import unidentifiable_directions
from recalib.laboratory.propose import propose
from recalib.laboratory.summary import errors_table, notes, verdict
from recalib.laboratory.universal_robots import kinematics_yaml
from recalib.laboratory.urdf import angles_of, corrected_urdf, with_origins
from recalib.laboratory.viewing import link_placements
from recalib.nominal.arms import find_urdf, load_arm
from recalib.nominal.denavit_hartenberg import arm_of_table
from tests.arms import urdf
from tests.identification.real import Real
from tests.identification.test_kept import coarse
from tests.kept import plain
from tests.laboratory.conftest import in_degrees, in_millimetres, postures, write
from tests.laboratory.test_urdf import random_calibration
from tests.logged import arranged, logged

NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
SLIDING = urdf(
    ("swing", "revolute", "0 0 1", "0 0 0.3"),
    ("lift", "revolute", "0 1 0", "0.05 0 0.1"),
    ("reach", "prismatic", "1 0 0", "0.3 0 0"),
    ("turn", "revolute", "1 0 0", "0.2 0.03 0.01"),
    ("flange", "fixed", "0 0 1", "0.15 0 0.02"),
    mass=3.0,
).replace(
    "</inertial>",
    '</inertial><visual><geometry><box size="0.1 0.2 0.3"/></geometry></visual>',
)
ROWS = 26
USAGE = "usage", " "  # how lines of it begin


def numbers(text: str) -> np.ndarray:
    its = np.array([float(its) for its in NUMBER.findall(text)])
    return its[np.abs(its) < 1e100]  # beyond, a URDF has no limit


def words(text: str) -> list[str]:
    text = re.sub(r"/\S*/", "", text)  # folders
    return sorted({*map(untied, NUMBER.sub("#", text).splitlines())})


def untied(line: str) -> str:
    """With parameters in one order: where several targets tie, rounding decides."""
    head, colon, names = line.rpartition(": ")
    return f"{head}{colon}{' or '.join(sorted(re.split(', | or ', names)))}"


def cells(path: Path) -> dict[str, tuple[str, ...]]:
    """The columns of a table."""
    heading, *rows = csv.reader(StringIO(path.read_text(encoding="utf-8")))
    return dict(zip(heading, zip(*rows, strict=True), strict=True))


def of_table(path: Path) -> dict:
    """The columns of a table, with rounded numbers."""
    found = cells(path)
    for name, column in found.items():
        with suppress(ValueError):
            found[name] = coarse([float(its or "nan") for its in column], 3)
    return found


@pytest.fixture(scope="module")
def lab(tmp_path_factory):
    """Arms and what was measured of them, by name."""
    folder = tmp_path_factory.mktemp("kept")
    (folder / "sliding.urdf").write_text(SLIDING)
    arm = load_arm(folder / "sliding.urdf")
    real, rng = Real(arm, 4, targets=2, gears=0.002), np.random.default_rng(5)
    joints = rng.uniform(-0.9, 0.9, (ROWS, 4)) * [1.0, 0.8, 0.2, 1.1] + [0.1, -0.3, 0.4, 0.2]
    joints[:, 3] = np.where(np.arange(ROWS) % 7 == 2, joints[::-1, 3], joints[:, 3])
    clock = np.cumsum(rng.uniform(0.3, 2.0, ROWS))
    columns = in_degrees(arm, joints)
    columns = {name: its for name, its in columns.items() if "reach" not in name}
    columns["reach [cm]"] = 100 * joints[:, 2]
    poses = real.poses(joints)
    poses[6, :3, 3] += 0.02
    turns = Rotation.from_matrix(poses[:, :3, :3]).as_quat()
    nominal = 1e3 * (real.base @ arm.forward(joints))[:, :3, 3] + rng.normal(
        scale=0.2, size=(ROWS, 3)
    )
    its = columns | in_millimetres(poses[:, :3, 3])
    its |= {f"q{axis}": turns[:, index] for index, axis in enumerate("xyzw")}
    its |= {f"{axis}_nominal [mm]": nominal[:, index] for index, axis in enumerate("xyz")}
    write(folder / "poses.csv", its | {"time [min]": clock / 60, "note": ["x"] * ROWS})
    stand = np.linalg.inv(real.base)
    angles = np.degrees(Rotation.from_matrix(stand[:3, :3]).as_euler("xyz"))
    place = ", ".join(f'"{1e3 * number:.6f} mm"' for number in stand[:3, 3])
    turned = ", ".join(f'"{number:.6f} deg"' for number in angles)
    (folder / "poses.toml").write_text(
        f'[columns]\nnote = "ignored"\n[instrument]\nposition = [{place}]\n'
        f"roll_pitch_yaw = [{turned}]\n"
    )
    numbers = np.arange(ROWS) % 2
    balls = real.poses(joints, numbers)[:, :3, 3]
    names = np.array(["small", "large"])[numbers]
    write(folder / "targets.csv", columns | in_millimetres(balls) | {"target": names})
    return folder


@pytest.fixture(scope="module")
def made(lab, in_sockets):
    """A calibration by name, made when it is asked for."""
    known = {}

    def make(name: str):
        if name not in known:
            known[name] = {
                "poses": lambda: calibrate_arm(
                    lab / "sliding.urdf", lab / "poses.csv", lab / "poses.toml"
                ),
                "targets": lambda: calibrate_arm(lab / "sliding.urdf", lab / "targets.csv"),
                "sockets": lambda: calibrate_arm(
                    "panda.urdf",
                    in_sockets,
                    Description(distances={("left", "right"): 0.3}),
                    "panda_hand_tcp",
                ),
            }[name]()
        return known[name]

    return make


@pytest.mark.parametrize("name", ["poses", "targets", "sockets"])
def test_what_is_said_of_a_calibration_is_as_kept(name, made, data_regression):
    its = made(name)
    table = errors_table(its)
    found = {
        "verdict": verdict(its),
        "notes": [untied(re.sub(r".*/", "", line)) for line in notes(its)[name == "sockets" :]],
        "errors": [[*row.values()][:4] for row in table],
        "of errors": coarse([[*row.values()][4:] for row in table], 3),
        "open": [[untied(one), told] for one, told in unidentifiable_directions(its)],
        "rows": [its.doubted, its.counted, its.worthwhile, its.observations.targets],
        "positions": coarse(its.positions, 3),
        "residuals": {kind: coarse(one, 3) for kind, one in its.residuals.items()},
        "places": [
            [one.name, one.link, one.turned, coarse(one.pose, 3)]
            + [coarse(many, 2) for many in (one.deviations, one.real_deviations)]
            for one in its.places
        ],
        "faults": [[one.kind, coarse(one.size, 2), one.row] for one in its.faults],
        "between": its.between,
    }
    data_regression.check(plain(found))


@pytest.mark.parametrize("name", ["poses", "targets"])
def test_the_files_of_a_calibration_are_as_kept(name, made, tmp_path, data_regression):
    its, folder = made(name), tmp_path / "calibration"
    written = write_files(its, folder, optional_outputs()[0])
    page = (folder / "page.html").read_text(encoding="utf-8")
    text = re.sub(r"<svg.*?</svg>|<style.*?</style>", "", page, flags=re.DOTALL)
    found = {
        "files": written,
        "tables": {
            path.name: of_table(path)
            for path in sorted(folder.glob("*.csv"))
            if path.name != "parameters.csv"
        },
        "parameters": cells(folder / "parameters.csv")["decided_by"],
        "summary": words((folder / "summary.txt").read_text()),
        "urdf": coarse(numbers((folder / "arm.urdf").read_text()), 4),
        "page": [line for line in words(text) if line.strip()][:40],
    }
    data_regression.check(plain(found))


def test_the_recording_of_a_calibration_is_as_kept(made, tmp_path, data_regression):
    watching.write_recording(tmp_path / "its.rrd", made("poses"))
    found = {
        key: [coarse(one, 3) if isinstance(one, np.ndarray) else one for one in its]
        for key, its in logged(tmp_path / "its.rrd").items()
        if "/__properties" not in key
    }
    data_regression.check(plain([found, arranged(watching._blueprint(20.0))]))


def test_corrections_of_an_arm_with_a_ball_in_sockets_are_as_kept(made, data_regression):
    """It has no instrument, and poses of six coordinates."""
    correction = made("sockets").correction
    rows = slice(3, 40, 9)
    poses = correction.calibration.forward(correction.learned[rows] + 0.01)
    desired = Measurements(5, positions=poses[:, :3, 3], rotations=poses[:, :3, :3])
    commands = correct(correction, desired)
    found = {"unidentifiable": unidentifiable_ends(correction), "beyond": commands.beyond}
    found |= {"joints": coarse(commands.joints, 3), "poses": coarse(commands.poses, 3)}
    for name, ask in {
        "to an instrument": lambda: correct(correction, desired, in_instrument=True),
        "drawn": lambda: propose(correction, 2),
    }.items():
        with pytest.raises(RecalibError) as refused:
            ask()
        found[name] = str(refused.value)
    data_regression.check(plain(found))


def test_what_descriptions_say_wrongly_is_as_kept(arm, in_sockets, data_regression):
    real = Real(arm, 7)
    joints = postures(9, 24)
    rows = Observations(joints, real.poses(joints)[:, :3, 3])
    stand, target = np.linalg.inv(real.base), real.targets[0]
    off = np.eye(4)
    off[:3, :3] = Rotation.from_euler("xyz", [0.9, -0.4, 1.3]).as_matrix()
    off[:3, 3] = 0.7, -0.5, 0.4
    cases = {
        "instrument": (stand @ off, None),
        "target": (None, target @ off),
        "instrument beside a target": (off @ stand, target),
        "target beside an instrument": (stand, off @ target),
        "both": (off @ stand, off @ target),
    }
    found = {}
    for name, given in cases.items():
        with pytest.raises(RecalibError) as refused:
            checked_frames(arm, rows, *given)
        found[name] = str(refused.value)
    panda = load_arm("panda.urdf", "panda_hand_tcp")
    seated = read_measurements(in_sockets, panda)
    sockets = np.unique(seated.sockets, return_inverse=True)[1]
    balls = Observations(seated.joints, sockets=sockets, distances=[Distance(0, 1, 0.41)])
    frames = checked_frames(panda, balls)
    with pytest.raises(RecalibError) as refused:
        check_distances(panda, balls, frames, ["left", "right"])
    found["distance"] = str(refused.value)
    data_regression.check(plain(found))


@pytest.mark.parametrize("name", ["poses", "targets"])
def test_corrections_and_proposals_are_as_kept(name, made, tmp_path, data_regression):
    its = made(name)
    its.correction.save(tmp_path / "its.npz")
    correction = load_correction(tmp_path / "its.npz")
    learned = correction.learned[:6] + 0.02
    joints = Measurements(6, coordinates=learned)
    positions = Measurements(6, positions=correction.calibration.forward(learned)[:, :3, 3])
    seen = correction.calibration.predict(learned, np.arange(6) % len(correction.targets))
    names = np.array(correction.targets)[np.arange(6) % len(correction.targets)]
    measured = Measurements(6, positions=seen[:, :3, 3], targets=names)
    commands = [correct(correction, joints), correct(correction, positions)]
    commands.append(correct(correction, measured, in_instrument=True))
    candidates = Measurements(6, coordinates=np.concatenate([learned[:5], [[1.9] * 4]]))
    proposals = propose(correction, 5), propose(correction, 3, candidates)
    proposals = *proposals, propose(correction, 2, positions)
    found = {
        "unidentifiable": unidentifiable_ends(correction),
        "commands": [[coarse(one.joints, 3), coarse(one.poses, 3), one.beyond] for one in commands],
        "solved": [coarse(part, 3) for part in solve(correction, positions)[::2]],
        "proposals": [
            [coarse(one.joints, 3), coarse(one.uncertainty, 2), one.worthwhile] for one in proposals
        ],
        "targets": correction.targets,
    }
    far = Measurements(2, positions=np.array([[0.5, 0.1, 0.4], [9.0, 0.0, 0.3]]))
    with pytest.raises(RecalibError) as refused:
        correct(correction, far)
    found["far"] = re.sub(r"leaves .*", "", str(refused.value))
    data_regression.check(plain(found))


def test_doubts_are_as_kept(made, data_regression):
    its = made("poses")
    kinds = [Fault(LAG, 0.12), Fault(LAG, -0.034), Fault(DRIFT, 0.0012), Fault(JUMP, 0.0034, 17)]
    kinds.append(Fault(SLIP, 0.0012, 17, 0.0034))
    sessions = [
        (of.observations, of.frames, of.tables, of.instruments, of.ends)
        for of in (its, made("targets"))
    ]
    found = [[in_words(one, *session) for session in sessions] for one in kinds]
    validation, told = its.validation, {}
    whole = replace(validation.held_out[RANDOM][HYBRID], residuals=np.full((ROWS, 6), 1e-4))
    held_out = validation.held_out | {RANDOM: validation.held_out[RANDOM] | {HYBRID: whole}}
    for chosen in KINDS:
        patterned = replace(validation, held_out=held_out, chosen=chosen)
        told[chosen] = [*doubts(replace(its, validation=patterned))]
    data_regression.check(plain([found, [*doubts(its)], told]))


@pytest.mark.parametrize("name", [("ur5_robot.urdf", "tool0"), ("panda.urdf", "panda_link8")])
def test_corrected_descriptions_are_as_kept(name, data_regression):
    arm = load_arm(*name)
    calibration, source = random_calibration(arm, 3), find_urdf(name[0]).read_bytes()
    text, tool = corrected_urdf(source, calibration)
    lines = {*source.decode().splitlines()}
    new = [line for line in text.decode().splitlines() if line not in lines]
    poses = arm.forward(np.random.default_rng(1).uniform(-1, 1, (3, len(arm.joints))))
    kinematics = kinematics_yaml(calibration)
    found = {
        "tool": tool,
        "lines": [NUMBER.sub("#", line) for line in new],
        "numbers": [coarse(numbers(line), 6) for line in new],
        "angles": [angles_of(pose) for pose in poses],
        "joint": len(with_origins(source, {arm.joints[1]: poses[0]}, "<!-- end -->")) - len(source),
        "kinematics": kinematics
        and [
            NUMBER.sub("#", kinematics.partition("hash")[0]),
            numbers(kinematics.partition("hash")[0]),
        ],
        "placements": link_placements(
            arm, [arm.tool, arm.base], np.zeros((1, len(arm.joints))) + 0.2
        ),
    }
    data_regression.check(plain(found))


TABLES = {
    "good": "a [deg],b [mm],c,d\n1,2,3,x\n-4.5,6e1,7,y\n\n",
    "empty": "",
    "header": "a [deg]\n",
    "semicolons": "a [deg];b [mm]\n1;2\n",
    "cells": "a [deg],b [mm]\n1\n",
    "twice": "a [deg],a [rad]\n1,2\n",
    "heading": "a [deg\n1\n",
}


def test_tables_are_read_as_kept(tmp_path, data_regression):
    from recalib.files.quantities import ANGLE, LENGTH, TIME
    from recalib.laboratory.columns import NUMBER as BARE

    found = {}
    for name, text in TABLES.items():
        path = tmp_path / f"{name}.csv"
        path.write_text(text, encoding="utf-8")
        try:
            table = read_table(path)
        except RecalibError as error:
            found[name] = str(error).replace(f"{tmp_path}/", "")
            continue
        found[name] = [len(table), table.units, table.cells, table.headings, "b" in table]
        for column, kind in (("a", ANGLE), ("b", LENGTH), ("c", BARE), ("d", BARE), ("a", TIME)):
            try:
                found[name].append(table.numbers(column, kind))
            except RecalibError as error:
                found[name].append(str(error).replace(f"{tmp_path}/", ""))
    path.write_text("t\n2026-11-23T08:15:00.5\n2026-11-23T09:15:00+01:00\n", encoding="utf-8")
    found["dates"] = read_table(path).dates("t")
    path.write_text("far [m],mine\n11,3\n2,4\n", encoding="utf-8")
    described = read_table(path, {"mine": "turn [deg]"})
    for column, kind in (("far", LENGTH), ("turn", ANGLE)):
        try:
            found[column] = described.numbers(column, kind)
        except RecalibError as error:
            found[column] = str(error).replace(f"{tmp_path}/", "")
    data_regression.check(plain(found))


@pytest.mark.parametrize("turns", ["rx,ry,rz", "roll,pitch,yaw", "qx,qy,qz,qw"])
def test_rows_are_read_as_kept(turns, lab, tmp_path, data_regression):
    arm, rng, count = load_arm(lab / "sliding.urdf"), np.random.default_rng(6), 12
    names = ["swing [deg]", "lift [rad]", "reach [mm]", "turn [deg]"]
    names += ["x_nominal [mm]", "y_nominal [cm]", "z_nominal [m]"]
    names += ["x_missed [mm]", "y_missed [mm]", "z_missed [mm]"]
    angles = turns.split(",")
    names += [name if name[0] == "q" else f"{name} [deg]" for name in angles]
    cells = rng.uniform(-1, 1, (count, len(names)))
    if len(angles) == 4:
        cells[:, -4:] /= np.linalg.norm(cells[:, -4:], axis=1, keepdims=True)
    its = dict(zip(names, cells.T, strict=True)) | {"time [ms]": np.arange(count) * 3.5}
    write(tmp_path / "rows.csv", its | {"target": ["a", "b", "c"] * 4})
    read = read_measurements(tmp_path / "rows.csv", arm)
    write(tmp_path / "desired.csv", {name: its[name] for name in names[:4]})
    desired = read_desired(tmp_path / "desired.csv", arm)
    data_regression.check(plain([read, read.measured, desired.joints]))


def test_descriptions_are_read_as_kept(tmp_path, data_regression):
    texts = {
        "whole": '[columns]\nq1 = "swing [deg]"\n'
        '[instrument]\nposition = ["1 m", "-2 cm", "3 mm"]\n'
        'roll_pitch_yaw = ["10 deg", "-0.2 rad", "30 deg"]\n[target]\n'
        'position = ["4 mm", "5 cm", "0.1 m"]\n[[distance]]\nsockets = ["b", "a"]\n'
        'length = "30 cm"\n',
        "turned": '[target]\nroll_pitch_yaw = ["1 deg", "2 deg", "3 deg"]\n',
        "part": "[tool]\n",
        "far": '[target]\nposition = ["11 m", "0 m", "0 m"]\n',
        "unit": '[target]\nposition = ["1 deg", "0 m", "0 m"]\n',
        "two": '[target]\nposition = ["1 m", "0 m"]\n',
        "distance": '[[distance]]\nsockets = ["a", "a"]\nlength = "1 m"\n',
        "nothing": '[[distance]]\nsockets = ["a", "b"]\nlength = "0 m"\n',
        "again": 2 * '[[distance]]\nsockets = ["a", "b"]\nlength = "2 m"\n',
    }
    found = {}
    for name, text in texts.items():
        path = tmp_path / f"{name}.toml"
        path.write_text(text, encoding="utf-8")
        try:
            its = read_description(path)
            found[name] = [its.columns, its.instrument, its.target, [*its.distances.items()]]
        except RecalibError as error:
            found[name] = str(error).replace(f"{tmp_path}/", "")
    data_regression.check(plain(found))


@pytest.mark.parametrize("convention", ["standard", "modified"])
def test_the_description_of_a_table_is_as_kept(convention, tmp_path, data_regression):
    path = tmp_path / "links.csv"
    path.write_text(
        "joint,a [mm],alpha [deg],d [cm],theta [rad],kind\n"
        "waist,12,-90,41.2,0.1,revolute\nrail,300,35,2,0.3,prismatic\nroll,7,20,11,-0.4,revolute\n"
    )
    rows = read_rows(path)
    text = urdf_of(arm_of_table(rows, convention))
    data_regression.check(
        plain([rows, NUMBER.sub("#", text).splitlines(), np.round(numbers(text), 9)])
    )


def test_what_the_command_line_prints_is_as_kept(calibrated, tmp_path, capsys, data_regression):
    table = calibrated.parent / "measurements.csv"
    found = {}
    links = tmp_path / "links.csv"
    links.write_text("joint,a [mm],alpha [deg],d [mm],theta [deg]\nwaist,7,-90,412,3\n")
    for name, command in {
        "calibrate": ["calibrate", calibrated.parent / "arm.urdf", table],
        "urdf": ["urdf", links, "--convention=modified"],
        "correct": ["correct", calibrated, table],
        "to the instrument": ["correct", calibrated, table, "--frame=instrument"],
        "next": ["next", calibrated, "--count=3"],
        "no count": ["next", calibrated, "--count=0"],
        "gone": ["correct", calibrated, tmp_path / "gone.csv"],
    }.items():
        out = tmp_path / f"{name.replace(' ', '_')}.csv"
        try:
            code = main([*map(str, command), f"--out={out}"])
        except SystemExit as error:
            code = error.code
        said = capsys.readouterr()
        lines = [*said.out.splitlines(), *said.err.splitlines()]
        lines = [re.sub(r"/\S*/", "", line) for line in lines if not line.startswith(USAGE)]
        found[name] = [
            code,
            lines,
            of_table(out) if command[0] in ("correct", "next") and out.exists() else None,
        ]
    data_regression.check(plain(found))
