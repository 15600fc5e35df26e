"""The files of a calibration."""

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from recalib.errors import InvalidFile
from recalib.identification.hand_eye import calibrate_hand_eye
from recalib.identification.hand_eye import held_out as without_fold
from recalib.identification.held_out import HeldOut
from recalib.identification.model.hand_eye_model import Sights
from recalib.identification.validation import BLOCKWISE, GEOMETRIC, NOTHING, WAYS
from recalib.laboratory.correction import NAME, Correction
from recalib.laboratory.places import Place, hand_eye_places
from recalib.laboratory.report.summary import DOING, errors_table, pixel_error, summary, verdict
from recalib.laboratory.report.templates import render
from recalib.laboratory.results import Results
from recalib.laboratory.tables.table import table_text
from recalib.laboratory.urdf.universal_robots import kinematics_yaml
from recalib.nominal.arms import arm_of

URDF, HAND_EYE = "arm.urdf", "hand_eye.toml"
PROBES, ROUNDING = 10, 1e-9  # random postures to compare files at; largest difference [m, rad]


def files_of(result: Results) -> dict[str, bytes]:
    """All files of a calibration by name, in the order of listing.

    The URDF and the correction are read back. Raises InvalidFile if their forward kinematics
    differ from those of the calibration.
    """
    files = {"summary.txt": summary(result).encode()}
    if result.worthwhile:
        files |= _calibration(result)
        _check(result, files)
    if result.places:
        files["frames.csv"] = table_text(map(_frame, result.places, [result] * len(result.places)))
    files["rows.csv"] = table_text(_rows(result))
    if (lens_files := result.data.lens_files) is not None:
        used = result.geometry if result.worthwhile else result.calibration
        optics = used.estimate.parameters[used.model.optics_columns]
        files[HAND_EYE] = hand_eye(result).encode()
        files |= lens_files(optics)
    return files


def _calibration(result: Results) -> dict[str, bytes]:
    geometry, (urdf, tool), data = result.geometry, result.corrected, result.data
    parameters = result.identified
    frames = geometry.frames
    bases = dict(zip(data.instruments, frames.bases.tolist(), strict=True))
    offsets = [row for row in parameters if row["name"].startswith("offset of ")]
    values = {
        "verdict": verdict(result),
        "tool": tool,
        "base": result.arm.base,
        "errors": [row._asdict() for row in errors_table(result)],
        "fit": DOING[GEOMETRIC],  # of all entries below
        "noise": geometry.estimate.noise.tolist(),
        "base_in_instrument": frames.base.tolist() if len(bases) == 1 else bases,
        "targets_in_tool": dict(zip(data.targets, frames.targets.tolist(), strict=True)),
        "sockets": dict(zip(data.sockets, frames.sockets.tolist(), strict=True)),
        "frames": [_frame(place, result) for place in result.places],
        "joint_offsets": dict(zip(result.arm.joints, offsets, strict=True)),
        "parameters": parameters,
    }
    files = {URDF: urdf, NAME: result.correction.archive()}
    if (kinematics := kinematics_yaml(geometry)) is not None:
        files["kinematics.yaml"] = kinematics.encode()
    return files | {"parameters.json": (json.dumps(values, indent=2) + "\n").encode()}


def _check(result: Results, files: dict[str, bytes]) -> None:
    """Raise InvalidFile unless the arms read back from the files are the calibrated ones."""
    low, high = (end(result.data.observations.joints, axis=0) for end in (np.min, np.max))
    joints = np.random.default_rng(0).uniform(low, high, (PROBES, len(low)))
    urdf, (_, tool) = Path(URDF), result.corrected
    correction = Correction.from_archive(files[NAME], Path(NAME))
    try:
        reached = arm_of(files[URDF], urdf, tool, result.arm.base).forward(joints)
    except Exception as error:
        raise InvalidFile(urdf, f"what was written cannot be read back: {error}") from None
    for name, found, expected in (
        (URDF, reached, result.geometry.forward(joints)),
        (NAME, correction.calibration.forward(joints), result.calibration.forward(joints)),
    ):
        if (off := np.abs(found - expected).max()) > ROUNDING:
            reason = f"read back, its forward kinematics are {off:.2g} m or rad off; please report"
            raise InvalidFile(name, f"{reason} this with the URDF")


def _frame(place: Place, result: Results) -> dict[str, Any]:
    """The cells of an identified place; unknown values are empty."""
    fit = DOING[GEOMETRIC if result.worthwhile else NOTHING]
    numbers = {
        **dict(zip(("x [mm]", "y [mm]", "z [mm]"), 1e3 * place.position, strict=True)),
        **dict(zip(("roll [deg]", "pitch [deg]", "yaw [deg]"), place.degrees, strict=True)),
        "deviation [mm]": 1e3 * place.deviations[0],
        "deviation [deg]": np.degrees(place.deviations[1]),
        "deviation relative to the real link [mm]": 1e3 * place.real_deviations[0],
        "deviation relative to the real link [deg]": np.degrees(place.real_deviations[1]),
    }
    known = {
        name: f"{number:.6g}" if place.turned or "mm" in name else ""
        for name, number in numbers.items()
    }
    return {"frame": place.name, "in": place.link} | known | {"fit": fit}


def _rows(result: Results) -> Iterator[dict[str, Any]]:
    """For each row, its held-out errors before and after, and its weight."""
    validation, weights = result.validation, result.geometry.estimate.weights
    before, after = (
        1e3 * validation.held_out[BLOCKWISE][kind].errors[:, 0]
        for kind in (NOTHING, validation.chosen)
    )
    for row, weight in enumerate(weights):
        yield {
            "row": row + 1,
            "before [mm]": f"{before[row]:.5g}",
            "after [mm]": f"{after[row]:.5g}",
            "weight": f"{weight:.3g}",
            "outlier": "yes" if row + 1 in result.doubted else "no",
        }


def hand_eye(result: Results) -> str:
    """A TOML with all frames and held-out errors, and again with the nominal arm taken as exact."""
    validation = result.validation
    held_out = {way: validation.held_out[way][validation.chosen] for way in WAYS}
    parts = ("", result.places, held_out), ("arm_as_right.", *_arm_as_right(result, held_out))
    values = []
    for prefix, places, found in parts:
        means = {}
        for way, errors in found.items():
            judged = validation.judged(way)
            off = float(errors[judged].errors[:, 0].mean())
            means[way] = off, pixel_error(errors, judged)
        values.append((prefix, places, means))
    return render("hand_eye.toml.j2", parts=values)


def _arm_as_right(
    result: Results, held_out: Mapping[str, HeldOut]
) -> tuple[list[Place], dict[str, HeldOut]]:
    """Places of cameras and boards if the nominal arm is exact, and their errors in the same folds.

    The place of a camera or a board is taken from its first sight.
    """
    data, arm = result.data, result.arm
    rows, links = data.observations, (arm.base, arm.tool)
    assert rows.measured is not None and rows.optics is not None
    flange, places = arm.forward(rows.joints), dict[str, Place]()
    residuals = {way: np.zeros((len(rows), 6)) for way in held_out}
    for sight, pair in enumerate(result.geometry.frames.sights):
        members = np.flatnonzero(rows.targets == sight)
        found = calibrate_hand_eye(Sights(flange, rows.measured, False, rows.optics)[members])
        for way, part in residuals.items():
            part[members] = without_fold(found, held_out[way].folds[members])
        names = data.instruments[pair[0]], data.target_names[pair[1]]
        for place in hand_eye_places(found, names, links):
            places.setdefault(place.name, place)
    errors = {way: HeldOut(residuals[way], held_out[way].folds, rows.optics) for way in held_out}
    return [*places.values()], errors
