"""What a live calibration has to show, measured: python -m tests.station.bars prints the tables.

Simulated arms are off as in tests/identification/real.py, with gears that are right or eccentric;
the instrument's noise is 0.05 mm and 0.01 degrees along an axis. Errors are means over 200 postures
of the same workspace; before, those of the nominal arm with instrument and target where they are.
"""

import os

os.environ["OPENBLAS_NUM_THREADS"] = "1"  # as the command does

import tempfile
import time
from pathlib import Path

import numpy as np

from recalib.identification.calibration import calibrate
from recalib.identification.initial_estimate import initial_frames
from recalib.identification.observations import Observations
from recalib.identification.validation import CANDIDATES, HYBRID
from recalib.laboratory.allowed import AllowedPostures
from recalib.laboratory.correction import Correction
from recalib.laboratory.corrector import Corrector
from recalib.laboratory.description import Description
from recalib.laboratory.live import LiveSettings, calibrate_live
from recalib.laboratory.record import Record
from recalib.laboratory.running import RunningCalibration
from tests.identification.real import ARMS, Real
from tests.station.simulated import HOMES, Simulated

FINE = 5e-5, np.radians(0.01)  # m, rad
DRAWS, ERROR, GEARS = 10, 3e-4, np.radians(0.03)
TIMES = 20  # that are measured, for a median


class Live:
    """A live calibration of one arm, from where it stands to its end."""

    def __init__(self, name: str, seed: int, gears: float):
        station = Simulated(name, seed, FINE)
        station.real = Real(station.arm, seed, gears=gears)
        with tempfile.TemporaryDirectory() as folder:
            table, settings = Path(folder) / "table.csv", LiveSettings(ERROR)
            self.reason = calibrate_live(
                lambda: station, station.arm, table, settings, lambda posture: True
            )
            record = Record(table, station.arm, Description())
            self.rows = record.observations
            record.close()
        home = np.array(HOMES[name], dtype=float)
        postures = AllowedPostures(station.arm, home, station.limits, settings.span, None)
        self.running = RunningCalibration(station.arm, Description(), postures)
        self.fresh = postures.joints[-200:]
        self.true = station.real.poses(self.fresh, noise=(0, 0))
        self.predicted = 1e3 * self.running.error(self.rows).total
        nominal = station.real.base @ station.arm.forward(self.fresh) @ station.real.targets[0]
        self.before = self.error(nominal)
        self.after = self.error(self.running.calibration(self.rows).predict(self.fresh))

    def error(self, poses: np.ndarray) -> float:
        """Mean [mm] of position."""
        gaps = poses - self.true
        return 1e3 * float(np.linalg.norm(gaps[:, :3, 3], axis=1).mean())


def outcomes() -> None:
    print(f"{DRAWS} draws each, until the predicted error is {1e3 * ERROR:g} mm or more is no use")
    heads = "arm", "eccentric gears", "rows (most)", "before", "after (largest)"
    print(f"| {' | '.join(heads)} | predicted over true (least) |")
    for name in ARMS:
        for gears in (0.0, GEARS):
            live = [Live(name, seed, gears) for seed in range(DRAWS)]
            rows = [len(its.rows) for its in live]
            before, after = ([getattr(its, what) for its in live] for what in ("before", "after"))
            ratio = [its.predicted / its.after for its in live]
            print(
                f"| {name} | {np.degrees(gears):.2f} deg | {np.median(rows):.0f} ({max(rows)})"
                f" | {np.median(before):.1f} mm | {np.median(after):.2f} mm ({max(after):.2f})"
                f" | {np.median(ratio):.1f} ({min(ratio):.1f}) |"
            )


def median(call) -> float:
    """Of the times [ms] that a call takes."""
    times = []
    for _ in range(TIMES):
        began = time.perf_counter()
        call()
        times.append(time.perf_counter() - began)
    return 1e3 * float(np.median(times))


def latencies(name: str) -> None:
    station = Simulated(name, 1, FINE)
    home, random = station.stands, np.random.default_rng(1)
    postures = AllowedPostures(station.arm, home, station.limits, np.radians(45), None)
    joints = random.uniform(*(home + side * np.radians(45) for side in (-1, 1)), (202, len(home)))
    rows = Observations(joints, station.real.poses(joints, noise=FINE))
    for count in (50, 100, 200):
        before, now = rows[:count], rows[: count + 1]

        def running():
            its = RunningCalibration(station.arm, Description(), postures)
            its.error(before)  # noqa: B023
            return its

        fresh = iter([running() for _ in range(TIMES)])
        update = median(lambda: next(fresh).error(now))  # noqa: B023
        last = running()
        last.error(now)
        proposal = median(lambda: last.next_posture(now, []))  # noqa: B023
        print(f"{name}, {count} rows: an update {update:.0f} ms, a proposal {proposal:.0f} ms")
    eccentric = Real(station.arm, 1, gears=GEARS)
    uneven = Observations(joints, eccentric.poses(joints, noise=FINE))
    for its in (rows, uneven):
        frames = initial_frames(station.arm, its)
        calibration = calibrate(station.arm, CANDIDATES[HYBRID], its, frames)
        corrector = Corrector(Correction(b"", calibration, joints))
        path = joints[:1] + np.linspace(0, 0.2, TIMES + 1)[:, None]
        pattern = "no pattern" if calibration.pattern is None else "a pattern"
        for frame, target, poses in (
            ("base", None, calibration.forward(path)),
            ("instrument", "the target", calibration.predict(path)),
        ):
            near, goals = [joints[0]], iter(poses)

            def command():
                near[0] = corrector.command(next(goals), near[0], target)  # noqa: B023

            command()
            print(
                f"{name}, {pattern} of residuals: a command in the {frame} {median(command):.2f} ms"
            )


if __name__ == "__main__":
    for name in ARMS:
        latencies(name)
    outcomes()
