"""Calibrate a station live, then correct one command after another as a controller's loop would."""

import tempfile
from pathlib import Path

import numpy as np
from station import BentUR10, in_room

from recalib import LiveSettings, calibrate_arm, calibrate_live, load_arm

arm, station = load_arm("ur10_robot.urdf", "tool0"), BentUR10()
table = Path(tempfile.mkdtemp()) / "measurements.csv"
calibrate_live(lambda: station, arm, table, LiveSettings(most=30))
correction = calibrate_arm("ur10_robot.urdf", table, tool="tool0").correction

command = np.array([0.1, -1.0, 1.8, -2.2, -1.5, 0.1])
before, after = [], []
for joints in command + np.linspace(0, 0.2, 50)[:, None]:
    goal = in_room(arm.forward(joints[None])[0])
    command = correction.command(goal, command)
    before.append(np.linalg.norm(station.position_at(joints) - goal))
    after.append(np.linalg.norm(station.position_at(command) - goal))
print(f"mean error before {1e3 * np.mean(before):.3g} mm, after {1e3 * np.mean(after):.3g} mm")
