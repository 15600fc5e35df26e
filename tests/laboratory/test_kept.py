"""All that a laboratory says and writes of synthetic arms, as it is kept in files."""

import csv
import re
from contextlib import suppress
from io import StringIO
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from recalib.errors import RecalibError
from recalib.laboratory.calibrate import calibrate_arm
from recalib.laboratory.correction.archive import load_correction
from recalib.laboratory.correction.correct import correct, solve, unidentifiable_ends
from recalib.laboratory.propose import propose
from recalib.laboratory.report import recording
from recalib.laboratory.report.files import optional_outputs, write_files
from recalib.laboratory.report.parameters import unidentifiable_directions
from recalib.laboratory.report.summary import errors_table, notes, verdict
from recalib.laboratory.tables.description import Description
from recalib.laboratory.tables.measurements import Measurements
from recalib.nominal.arms import load_arm
from tests.arms import urdf
from tests.identification.real import Real
from tests.identification.test_kept import coarse
from tests.kept import plain
from tests.laboratory.conftest import in_degrees, in_millimetres, write
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


def numbers(text: str) -> np.ndarray:
    its = np.array([float(its) for its in NUMBER.findall(text)])
    return its[np.abs(its) < 1e100]  # beyond, a URDF has no limit


def words(text: str) -> list[str]:
    text = re.sub(r"/\S*/", "", text)  # folders
    return sorted({*NUMBER.sub("#", text).splitlines()})


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
        "notes": [re.sub(r".*/", "", line) for line in notes(its)[name == "sockets" :]],
        "errors": [[*row.values()][:4] for row in table],
        "of errors": coarse([[*row.values()][4:] for row in table], 3),
        "open": [list(one) for one in unidentifiable_directions(its)],
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
    recording.write_recording(tmp_path / "its.rrd", made("poses"))
    found = {
        key: [coarse(one, 3) if isinstance(one, np.ndarray) else one for one in its]
        for key, its in logged(tmp_path / "its.rrd").items()
        if "/__properties" not in key
    }
    data_regression.check(plain([found, arranged(recording._blueprint(20.0))]))


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
        "commands": [
            [coarse(one.joints, 3), coarse(one.poses, 3), one.beyond > 0] for one in commands
        ],
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
