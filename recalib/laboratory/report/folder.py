"""The files of a calibration."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from recalib.errors import InvalidFile
from recalib.identification.validation import BLOCKWISE, GEOMETRIC, NOTHING
from recalib.laboratory.correction import NAME, Correction
from recalib.laboratory.places import Place
from recalib.laboratory.report.hand_eye import hand_eye
from recalib.laboratory.report.summary import DOING, errors_table, summary, verdict
from recalib.laboratory.results import Results
from recalib.laboratory.tables.table import table_text
from recalib.laboratory.urdf.universal_robots import kinematics_yaml
from recalib.nominal.arms import arm_of

URDF, HAND_EYE = "arm.urdf", "hand_eye.toml"
PROBES, ROUNDING = 10, 1e-9  # random postures at which files are compared, to so much m and rad


def files_of(result: Results) -> dict[str, bytes]:
    """All files of a calibration by name, in the order in which they are listed.

    The URDF and the correction are read back: their forward kinematics are those of the
    calibration. Raises InvalidFile if they are not.
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
        "fit": DOING[GEOMETRIC],  # of all that follows
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
    """Raise InvalidFile unless the arms that are read back from files are the calibrated ones."""
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
    """An identified place; unknown values are empty."""
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
    """For each row its error before and after, held out, and its weight."""
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
