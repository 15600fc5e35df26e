"""The folder of a calibration, and tables of postures."""

import json
from collections.abc import Callable, Iterable, Iterator, Sequence
from importlib import import_module
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.files.outputs import new
from recalib.identification.validation import BLOCKWISE, GEOMETRIC, NOTHING
from recalib.laboratory.arms.universal_robots import kinematics_yaml
from recalib.laboratory.arms.urdf import angles_of
from recalib.laboratory.calibrate import Calibrated
from recalib.laboratory.correction.archive import Correction, load_correction
from recalib.laboratory.report.hand_eye import hand_eye
from recalib.laboratory.report.parameters import described
from recalib.laboratory.report.summary import DOING, errors_table, summary, verdict
from recalib.laboratory.tables.columns import FAKE, POSE, write_table
from recalib.nominal.kinematics import Arm

CORRECTION, HAND_EYE = "correction.npz", "hand_eye.toml"
LENS, LENSES = "lens.yaml", "lens_{}.yaml"  # of the only camera, or of each by its name
NAMES = (  # in the order in which they are listed
    *("summary.txt", "arm.urdf", CORRECTION, "frames.csv", "parameters.csv", "parameters.json"),
    *("joint_offsets.csv", "rows.csv", "kinematics.yaml", HAND_EYE, LENS),
    *("page.html", "recording.rrd"),
)
PLACE = (  # the columns of frames.csv that are numbers
    *("x [mm]", "y [mm]", "z [mm]", "roll [deg]", "pitch [deg]", "yaw [deg]"),
    *("deviation [mm]", "deviation [deg]"),
    *("deviation beside the real link [mm]", "deviation beside the real link [deg]"),
)


def write_files(
    result: Calibrated,
    folder: str | PathLike[str],
    further: Sequence[tuple[str, Callable[[Path, Calibrated], None]]] = (),
) -> list[str]:
    """Write what is known into a new folder, and say which files there are. They appear together.

    Args:
        further: files to look at, by what writes them.

    Raises InvalidFile where something is there already, or nothing can be put there.
    """
    with new(folder, folder=True) as made:
        (made / "summary.txt").write_text(summary(result), encoding="utf-8")
        write_table(made / "rows.csv", _rows(result))
        if frames := [*_frames(result)]:
            write_table(made / "frames.csv", frames)
        if result.observations.optics is not None:
            _write_hand_eye(made, result)
        if result.worthwhile:
            _write_calibration(made, result)
        for name, write in further:
            write(made / name, result)
        lenses = sorted(path.name for path in made.glob(LENSES.format("*")))
        return [name for name in NAMES if (made / name).exists()] + lenses


def optional_outputs() -> tuple[list[tuple[str, Callable[[Path, Calibrated], None]]], list[str]]:
    """What writes the files to look at, and a sentence for each that cannot be written here."""
    writers, missing = [], []
    for name, module, function in (
        ("page.html", "recalib.laboratory.report.page", "write_page"),
        ("recording.rrd", "recalib.laboratory.report.recording", "write_recording"),
    ):
        try:
            writers.append((name, getattr(import_module(module), function)))
        except ModuleNotFoundError as error:
            package = (error.name or module).partition(".")[0]
            missing.append(f"No {name}: {package} is missing; pip install 'recalib[laboratory]'")
    return writers, missing


def read_correction(calibration: Path) -> Correction:
    """That of a calibration: of its folder, or the file alone. Raises InvalidFile."""
    return load_correction(calibration if calibration.is_file() else calibration / CORRECTION)


def write_postures(
    path: Path, arm: Arm, joints: np.ndarray, poses: np.ndarray, fake: bool = False
) -> None:
    """Write joint coordinates (n, joints) and poses (n, 4, 4) in the columns that we read.

    Args:
        fake: the poses are commands, in columns that `read_desired` refuses: they would be
            corrected twice.

    Raises InvalidFile where something is there already, or nothing can be put there.
    """
    scales = [1e3 if slides else 180 / np.pi for slides in arm.slides]
    units = ["mm" if slides else "deg" for slides in arm.slides]
    names = [f"{joint} [{unit}]" for joint, unit in zip(arm.joints, units, strict=True)]
    headings = [*names, *(FAKE if fake else POSE)]
    turns = Rotation.from_matrix(poses[:, :3, :3]).as_rotvec(degrees=True)
    numbers = np.concatenate([joints * scales, 1e3 * poses[:, :3, 3], turns], axis=1)
    texts = ([f"{number:.9f}" for number in row] for row in numbers)
    with new(path) as made:
        write_table(made, (dict(zip(headings, row, strict=True)) for row in texts))


def _write_calibration(folder: Path, result: Calibrated) -> None:
    geometry, (urdf, tool) = result.geometry, result.corrected
    (folder / "arm.urdf").write_bytes(urdf)
    if (kinematics := kinematics_yaml(geometry)) is not None:
        (folder / "kinematics.yaml").write_text(kinematics, encoding="utf-8")
    result.correction.save(folder / CORRECTION)
    parameters = [vars(parameter) for parameter in described(result)]
    write_table(folder / "parameters.csv", parameters)
    offsets = [its for its in parameters if its["name"].startswith("offset of ")]
    write_table(folder / "joint_offsets.csv", offsets)
    frames = geometry.frames
    bases = dict(zip(result.instruments, frames.bases.tolist(), strict=True))
    values = {
        "verdict": verdict(result),
        "tool": tool,
        "base": result.arm.base,
        "errors": errors_table(result),
        "fit": DOING[GEOMETRIC],  # of all that follows
        "noise": geometry.estimate.noise.tolist(),
        "base_in_instrument": frames.base.tolist() if len(bases) == 1 else bases,
        "targets_in_tool": dict(zip(result.targets, frames.targets.tolist(), strict=True)),
        "sockets": dict(zip(result.sockets, frames.sockets.tolist(), strict=True)),
        "frames": [*_frames(result)],
        "parameters": parameters,
    }
    text = json.dumps(values, indent=2) + "\n"
    (folder / "parameters.json").write_text(text, encoding="utf-8")


def _write_hand_eye(folder: Path, result: Calibrated) -> None:
    """Where cameras and boards are, and the lenses that go with it."""
    from recalib.laboratory.pictures.sessions import fitted_lenses  # OpenCV is there for pictures

    (folder / HAND_EYE).write_text(hand_eye(result), encoding="utf-8")
    calibration = result.geometry if result.worthwhile else result.calibration
    optics = calibration.estimate.parameters[calibration.model.optics_columns]
    assert result.sighted
    lenses = fitted_lenses(result.sighted, optics)
    for name, lens in lenses.items():
        file = LENS if len(lenses) == 1 else LENSES.format(name)
        (folder / file).write_text(lens.as_ros(), encoding="utf-8")


def _frames(result: Calibrated) -> Iterator[dict[str, Any]]:
    """Each place that was found; what is not known of it is empty."""
    for place in result.places:
        numbers = [*1e3 * place.pose[:3, 3], *np.degrees(angles_of(place.pose))]
        for length, turn in (place.deviations, place.real_deviations):
            numbers += [1e3 * length, np.degrees(turn)]
        known = {
            name: f"{number:.6g}" if place.turned or "mm" in name else ""
            for name, number in zip(PLACE, numbers, strict=True)
        }
        fit = DOING[GEOMETRIC if result.worthwhile else NOTHING]
        yield {"frame": place.name, "in": place.link} | known | {"fit": fit}


def _rows(result: Calibrated) -> Iterable[dict[str, Any]]:
    """For each row how far off it is, before and after, and how much it counted."""
    validation, weights = result.validation, result.geometry.estimate.weights
    before, after = (
        1e3 * validation.errors(BLOCKWISE, kind)[:, 0] for kind in (NOTHING, validation.chosen)
    )
    for row, weight in enumerate(weights):
        yield {
            "row": row + 1,
            "before [mm]": f"{before[row]:.5g}",
            "after [mm]": f"{after[row]:.5g}",
            "weight": f"{weight:.3g}",
            "doubted": "yes" if row + 1 in result.doubted else "no",
        }
