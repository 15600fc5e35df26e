"""The folder of a calibration, and tables of postures."""

import csv
import json
import shutil
import tempfile
from collections.abc import Callable, Iterable, Iterator, Sequence
from importlib import import_module
from os import PathLike
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.identification.validation import BLOCKWISE, GEOMETRIC, NOTHING
from recalib.laboratory.calibrate import Calibrated
from recalib.laboratory.outputs import new
from recalib.laboratory.parameters import described
from recalib.laboratory.summary import DOING, errors_table, summary, verdict
from recalib.laboratory.universal_robots import kinematics_yaml
from recalib.laboratory.urdf import angles_of
from recalib.nominal.kinematics import Arm

SUMMARY, URDF, CORRECTION = "summary.txt", "arm.urdf", "correction.npz"
FRAMES = "frames.csv"
TABLE, VALUES, OFFSETS, ROWS = "parameters.csv", "parameters.json", "joint_offsets.csv", "rows.csv"
KINEMATICS, PAGE, RECORDING = "kinematics.yaml", "page.html", "recording.rrd"
NAMES = (
    *(SUMMARY, URDF, CORRECTION, FRAMES, TABLE, VALUES, OFFSETS, ROWS),
    *(KINEMATICS, PAGE, RECORDING),
)


def write_files(
    result: Calibrated,
    folder: str | PathLike,
    further: Sequence[tuple[str, Callable[[Path, Calibrated], None]]] = (),
) -> list[str]:
    """Write what is known into a new folder, and say which files there are.

    They are made elsewhere first, and appear together.

    Args:
        further: files to look at, by what writes them.

    Raises InvalidFile where something is there already, or nothing can be put there.
    """
    with tempfile.TemporaryDirectory() as temporary:
        made = Path(temporary)
        (made / SUMMARY).write_text(summary(result), encoding="utf-8")
        _write_table(made / ROWS, _rows(result))
        if frames := [*_frames(result)]:
            _write_table(made / FRAMES, frames)
        if result.worthwhile:
            _write_calibration(made, result)
        for name, write in further:
            write(made / name, result)
        written = [name for name in NAMES if (made / name).exists()]
        with new(folder, folder=True) as there:
            for name in written:
                shutil.copyfile(made / name, there / name)
    return written


def looks() -> tuple[list[tuple[str, Callable[[Path, Calibrated], None]]], list[str]]:
    """What writes the files to look at, and a sentence for each that cannot be written here."""
    writers, missing = [], []
    for name, module, function in (
        (PAGE, "recalib.laboratory.page", "write_page"),
        (RECORDING, "recalib.laboratory.watching", "write_recording"),
    ):
        try:
            writers.append((name, getattr(import_module(module), function)))
        except ModuleNotFoundError as error:
            package = error.name.partition(".")[0]
            missing.append(f"No {name}: {package} is missing; pip install 'recalib[laboratory]'")
    return writers, missing


def write_postures(path: Path, arm: Arm, joints: np.ndarray, poses: np.ndarray) -> None:
    """Write joint coordinates (n, joints) and poses (n, 4, 4) in the columns that we read.

    Raises InvalidFile where something is there already, or nothing can be put there.
    """
    scales = [1e3 if slides else 180 / np.pi for slides in arm.slides]
    units = ["mm" if slides else "deg" for slides in arm.slides]
    names = [f"{joint} [{unit}]" for joint, unit in zip(arm.joints, units, strict=True)]
    names += [*(f"{axis} [mm]" for axis in "xyz"), *(f"r{axis} [deg]" for axis in "xyz")]
    turns = Rotation.from_matrix(poses[:, :3, :3]).as_rotvec(degrees=True)
    numbers = np.concatenate([joints * scales, 1e3 * poses[:, :3, 3], turns], axis=1)
    with new(path) as made:
        _write_table(
            made,
            (dict(zip(names, (f"{each:.9f}" for each in row), strict=True)) for row in numbers),
        )


def _write_calibration(folder: Path, result: Calibrated) -> None:
    geometry, (text, tool) = result.geometry, result.corrected
    (folder / URDF).write_bytes(text)
    if (kinematics := kinematics_yaml(geometry)) is not None:
        (folder / KINEMATICS).write_text(kinematics, encoding="utf-8")
    result.correction.save(folder / CORRECTION)
    parameters = [vars(each) for each in described(result)]
    _write_table(folder / TABLE, parameters)
    offsets = [each for each in parameters if each["name"].startswith("offset of ")]
    _write_table(folder / OFFSETS, offsets)
    frames = geometry.frames
    values = {
        "verdict": verdict(result),
        "tool": tool,
        "base": result.arm.base,
        "errors": errors_table(result),
        "fit": DOING[GEOMETRIC],  # of all that follows
        "noise": geometry.estimate.noise.tolist(),
        "base_in_instrument": frames.base.tolist(),
        "targets_in_tool": dict(zip(result.targets, frames.targets.tolist(), strict=True)),
        "sockets": dict(zip(result.sockets, frames.sockets.tolist(), strict=True)),
        "frames": [*_frames(result)],
        "parameters": parameters,
    }
    (folder / VALUES).write_text(json.dumps(values, indent=2) + "\n", encoding="utf-8")


def _frames(result: Calibrated) -> Iterator[dict]:
    """Each place that was found; what is not known of it is empty."""
    for place in result.places:
        numbers = dict(zip(("x [mm]", "y [mm]", "z [mm]"), 1e3 * place.pose[:3, 3], strict=True))
        turns = np.degrees(angles_of(place.pose))
        numbers |= dict(zip(("roll [deg]", "pitch [deg]", "yaw [deg]"), turns, strict=True))
        for what, (length, turn) in (
            ("deviation", place.deviations),
            ("deviation beside the real link", place.real_deviations),
        ):
            numbers |= {f"{what} [mm]": 1e3 * length, f"{what} [deg]": np.degrees(turn)}
        yield (
            {"frame": place.name, "in": place.link}
            | {
                name: "" if "deg" in name and not place.turned else f"{number:.6g}"
                for name, number in numbers.items()
            }
            | {"fit": DOING[GEOMETRIC if result.worthwhile else NOTHING]}
        )


def _rows(result: Calibrated) -> Iterable[dict]:
    """For each row how far off it is, before and after, and how much it counted."""
    validation, weights = result.validation, result.geometry.estimate.weights
    before = 1e3 * validation.errors(BLOCKWISE, NOTHING)[:, 0]
    after = 1e3 * validation.errors(BLOCKWISE, validation.chosen)[:, 0]
    doubted = {*result.doubted}
    for row, (old, left, weight) in enumerate(zip(before, after, weights, strict=True), start=1):
        yield {
            "row": row,
            "before [mm]": f"{old:.5g}",
            "after [mm]": f"{left:.5g}",
            "weight": f"{weight:.3g}",
            "doubted": "yes" if row in doubted else "no",
        }


def _write_table(path: Path, rows: Iterable[dict]) -> None:
    rows = list(rows)
    with path.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.DictWriter(stream, fieldnames=rows[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
