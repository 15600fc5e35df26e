"""Calibrations by figaroh, in its own environment.

    python by_figaroh.py TASKS PREDICTIONS

As its documentation has it: a subclass whose cost function weights positions and turns, full
parameters, both frames unknown, an estimation method by its name. Residuals are in units of the
noise, of which it estimates only the scale: if the noise is known, the scale is set to 1.
"""

import logging
import sys
import warnings
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pandas as pd
import pinocchio as pin
import yaml
from figaroh.calibration.base_calibration import BaseCalibration
from figaroh.calibration.calibration_tools import calc_updated_fkm
from figaroh.tools.load_robot import load_robot

METHODS = "structural", "map", "map_cv"  # the default one, and those that know what is plausible
MOST = 50  # rows for the last one, which fits 25 times
COLUMNS = [f"{name}1" for name in ("x", "y", "z", "phix", "phiy", "phiz")]
OUTLYING = 0.02  # m, as in figaroh's own example of a UR10


class Calibration(BaseCalibration):
    """Of one arm."""

    noise = 1.0, 1.0  # m, rad

    def cost_function(self, var):
        estimated = calc_updated_fkm(self.model, self.data, var, self.q_measured, self.calib_config)
        residuals = self._compute_logmap_residuals(self.PEE_measured, estimated)
        position, orientation = self.noise
        return self.apply_measurement_weighting(residuals, 1 / position, 1 / orientation)


def columns(measured: np.ndarray) -> np.ndarray:
    """Positions (n, 3) as they are; poses (n, 4, 4) as position, roll, pitch and yaw (n, 6)."""
    if measured.ndim == 2:
        return measured
    angles = [pin.rpy.matrixToRpy(pose[:3, :3]) for pose in measured]
    return np.concatenate([measured[:, :3, 3], angles], axis=1)


def predict(task: dict, method: str, folder: Path) -> np.ndarray:
    """Positions (m, 3) [m] that the calibrated arm should have in the fresh postures."""
    names, measured = task["names"].tolist(), columns(task["measured"])
    table = dict(zip(names, task["joints"].T, strict=True))
    table |= dict(zip(COLUMNS, measured.T, strict=False))
    pd.DataFrame(table).to_csv(folder / "measured.csv", index=False)
    measurable = [index < measured.shape[1] for index in range(6)]
    settings = {
        "parameters": {
            "calibration_level": "full_params",
            "outlier_threshold": OUTLYING,
            "estimation": {"method": method, "noise_std": 1.0 if task["known"] else None},
        },
        "kinematics": {"base_frame": "universe", "tool_frame": str(task["tool"])},
        "measurements": {"markers": [{"measurable_dof": measurable}]},
        "data": {"source_file": str(folder / "measured.csv"), "number_of_samples": len(measured)},
        "joints": {"active_joints": names},
    }
    text = yaml.safe_dump({"robot": {"name": "arm"}, "tasks": {"calibration": settings}})
    (folder / "settings.yaml").write_text(text, encoding="utf-8")
    robot = load_robot(str(task["urdf"]), package_dirs=str(task["packages"]))
    calibration = Calibration(robot, str(folder / "settings.yaml"))
    calibration.noise = tuple(task["noise"])
    calibration.calib_config |= {"known_baseframe": False, "known_tipframe": False}
    calibration.initialize()
    calibration.solve(enable_logging=False)
    fresh = np.tile(calibration.calib_config["q0"], (len(task["fresh"]), 1))
    fresh[:, calibration.calib_config["config_idx"]] = task["fresh"]
    config = calibration.calib_config | {"NbSample": len(fresh)}
    estimated = calc_updated_fkm(
        calibration.model, calibration.data, calibration.var_, fresh, config
    )
    return estimated.reshape(-1, len(fresh))[:3].T


def predict_all(task: dict) -> dict[str, np.ndarray]:
    """Positions by method, none of one that fails; with unknown frames, the default alone."""
    predictions = {}
    few, frames_known = len(task["joints"]) <= MOST, task["told"]
    for method in METHODS[: 1 if not frames_known else 3 if few else 2]:
        with TemporaryDirectory() as folder:
            try:
                predictions[f"figaroh, {method}"] = predict(task, method, Path(folder))
            except Exception as error:  # whatever a peer raises is its result
                print(f"{method}: {error!r}", file=sys.stderr)
                predictions[f"figaroh, {method}"] = np.empty((0, 3))
    return predictions


if __name__ == "__main__":
    logging.disable(logging.WARNING)
    warnings.simplefilter("ignore")
    for path in sorted(Path(sys.argv[1]).glob("*.npz")):
        print(path.stem, file=sys.stderr, flush=True)
        with np.load(path) as task:
            np.savez(Path(sys.argv[2]) / path.name, **predict_all(dict(task)))
