"""How fast a live calibration is next to an arm that waits: python -m tests.bars.latency.

Wall times of an update with one more row, of the next proposal, and of a corrected command, in a
process that has begun. Each is a median.
"""

import os

os.environ["OPENBLAS_NUM_THREADS"] = "1"  # as the command does

import time
from collections.abc import Callable

import numpy as np

from recalib import Arm, Correction, Description, Observations, initial_frames
from recalib.identification.calibration import calibrate
from recalib.identification.validation import CANDIDATES
from recalib.laboratory.live.allowed import AllowedPostures
from recalib.laboratory.live.running import RunningCalibration
from recalib.station.pictures import BoardInPictures
from tests.bars.live import FINE, GEARS
from tests.bars.stations import Seeing
from tests.identification.real import ARMS, Real
from tests.station.simulated import Simulated
from tests.vision.rendering import Cell

TIMES = 20  # that are measured, for a median


def median(call) -> float:
    """Of the times [ms] that a call takes."""
    times = []
    for _ in range(TIMES):
        start = time.perf_counter()
        call()
        times.append(time.perf_counter() - start)
    return 1e3 * float(np.median(times))


def live(
    name: str,
    arm: Arm,
    postures: AllowedPostures,
    rows: Callable[[int], Observations],
    pictures: BoardInPictures | None = None,
) -> None:
    """Of an update and of a proposal, by the first rows of some number."""
    for count in (50, 100, 200):

        def running():
            calibration = RunningCalibration(arm, Description(), postures, pictures)
            calibration.error(rows(count))  # noqa: B023
            return calibration

        each = [running() for _ in range(TIMES)]
        fresh, updated = iter(each), iter(each)
        update = median(lambda: next(fresh).error(rows(count + 1)))  # noqa: B023
        proposal = median(lambda: next(updated).next_posture(rows(count + 1), []))  # noqa: B023
        print(f"{name}, {count} rows: an update {update:.0f} ms, a proposal {proposal:.0f} ms")


def by_pictures() -> None:
    station = Seeing(Cell(1))
    cell, limits = station.cell, station.limits
    joints = cell.postures(201)
    for angles in joints:
        station.move(angles, 1.0)
        station.measure()
    names = [str(number) for number in range(1, 202)]

    def rows(count: int) -> Observations:
        poses, optics = station.pictures(names[:count])
        return Observations(joints[:count], poses, optics=optics)

    postures = AllowedPostures(cell.arm, joints[0], limits, np.radians(25), None)
    live("Panda by pictures", cell.arm, postures, rows, station.pictures)


def latencies(name: str) -> None:
    station = Simulated(name, 1, FINE)
    home, random = station.stands, np.random.default_rng(1)
    postures = AllowedPostures(station.arm, home, station.limits, np.radians(45), None)
    joints = random.uniform(*(home + side * np.radians(45) for side in (-1, 1)), (202, len(home)))
    rows = Observations(joints, station.real.poses(joints, noise=FINE))
    live(name, station.arm, postures, lambda count: rows[:count])
    eccentric = Real(station.arm, 1, gears=GEARS)
    uneven = Observations(joints, eccentric.poses(joints, noise=FINE))
    for table in (rows, uneven):
        frames = initial_frames(station.arm, table)
        calibration = calibrate(station.arm, CANDIDATES, table, frames)
        correction = Correction(b"", calibration, joints)
        path = joints[:1] + np.linspace(0, 0.2, TIMES + 1)[:, None]
        pattern = "no pattern" if calibration.pattern is None else "a pattern"
        last, goals = [joints[0]], iter(calibration.predict(path))

        def command():
            last[0] = correction.command(next(goals), last[0])  # noqa: B023

        command()
        print(f"{name}, {pattern} of residuals: a command {median(command):.2f} ms")


if __name__ == "__main__":
    for name in ARMS:
        latencies(name)
    by_pictures()
