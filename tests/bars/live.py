"""What a live calibration has to show, measured: python -m tests.bars.live prints the tables.

Simulated arms are off as in tests/identification/real.py, with gears that are right or eccentric.
Those in MuJoCo have bent links and shifted encoders, and droop. The instrument's noise is 0.05 mm
and 0.01 degrees along an axis. Errors are means over 200 postures of the same workspace; before,
those of the nominal arm with instrument and target where they are.
"""

import os
import sys

os.environ["OPENBLAS_NUM_THREADS"] = "1"  # as the command does

import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pinocchio as pin
from simulated_arm import Gears, PhysicsStation

from recalib import (
    Arm,
    DamagedArm,
    Description,
    Disturbances,
    Noise,
    Observations,
    Station,
    load_arm,
)
from recalib.identification.closed_forms import solutions
from recalib.laboratory.live.allowed import AllowedPostures
from recalib.laboratory.live.record import Record
from recalib.laboratory.live.running import RunningCalibration
from recalib.laboratory.live.session import LiveSettings, calibrate_live
from recalib.station.pictures import BoardInPictures
from tests.bars.stations import Seeing
from tests.identification.real import ARMS, Real
from tests.station.simulated import HOMES, Simulated
from tests.vision.rendering import Cell

Forward = Callable[[np.ndarray], np.ndarray]
FINE, ROUGH = (5e-5, np.radians(0.01)), (1e-4, np.radians(0.01))  # m, rad
DRAWS, ERROR, GEARS = 10, 3e-4, np.radians(0.03)
FINER, SPAN = 2e-4, np.radians(25)  # m, rad: with a camera
STIFFNESS, FRICTION = 5e3, 2.0  # N m/rad, of each gear; N m


class Live:
    """A live calibration of one arm, from where it stands to its end.

    Args:
        arm: the nominal one.
        station: the real one.
        true, nominal: from postures to poses (n, 4, 4) [m] of the target in the instrument's frame.
        pictures: corners in the pictures that the station takes; None: its poses are used.
    """

    def __init__(
        self,
        arm: Arm,
        station: Station,
        true: Forward,
        nominal: Forward,
        pictures: BoardInPictures | None = None,
    ):
        self.station = station
        home = station.angles()
        settings = LiveSettings(ERROR)
        if pictures is not None:  # in some of these cells the board begins near the base plane
            settings = LiveSettings(FINER, span=SPAN, floor=None)
        self._shifted = pictures is not None
        with tempfile.TemporaryDirectory() as folder:
            table = Path(folder) / "table.csv"
            result = calibrate_live(lambda: station, arm, table, settings, pictures=pictures)
            self.reason = result.reason
            record = Record(table, arm, Description(), pictures)
            self.rows = record.observations
            record.close()
        self.postures = AllowedPostures(arm, home, station.limits, settings.span, None)
        self.running = RunningCalibration(arm, Description(), self.postures, pictures)
        self.fresh = self.postures.joints[-200:]
        self.true = true(self.fresh)
        self.predicted = 1e3 * self.running.error(self.rows)
        self.before = self.error(nominal(self.fresh))
        self.after = self.error(self.running.calibration(self.rows).predict(self.fresh))

    def error(self, poses: np.ndarray) -> float:
        """Mean [mm] of position; by pictures, after one shift and turn of base and tool."""
        if self._shifted:
            frames = next(solutions(poses, Observations(self.fresh, self.true)))
            poses = frames.base @ poses @ frames.targets[0]
        gaps = poses - self.true
        return 1e3 * float(np.linalg.norm(gaps[:, :3, 3], axis=1).mean())


def kinematic(name: str, seed: int, gears: float, noise: tuple[float, float] = FINE) -> Live:
    """With eccentric gears [rad] and the instrument's noise [m, rad]."""
    station = Simulated(name, seed, noise)
    real = station.real = Real(station.arm, seed, gears=gears)
    return Live(
        station.arm,
        station,
        lambda joints: real.poses(joints, noise=(0, 0)),
        lambda joints: real.base @ station.arm.forward(joints) @ real.targets[0],
    )


def physical(name: str, seed: int, friction: float = 0.0) -> Live:
    """In MuJoCo, with bent links, shifted encoders and droop; friction in N m."""
    nominal, arm, random = load_arm(*ARMS[name]), load_arm(*ARMS[name]), np.random.default_rng(seed)
    placements = arm.model.jointPlacements
    for joint in range(1, len(placements)):
        bent = np.repeat([1e-3, np.radians(0.1)], 3) * random.standard_normal(6)  # m, rad
        placements[joint] = placements[joint] * pin.exp6(pin.Motion(bent))
    damaged = DamagedArm(arm, np.radians(0.5) * random.standard_normal(len(arm.joints)))
    gears = Gears(STIFFNESS, friction)
    noisy = PhysicsStation(damaged, gears, disturbances=Disturbances(Noise(*FINE)), seed=seed)
    noisy.move(np.array(HOMES[name], dtype=float))
    return Live(nominal, noisy, PhysicsStation(damaged, gears).forward, nominal.forward)


def pictured(seed: int, in_hand: bool) -> Live:
    """A Panda of the bars of pictures, by corners."""
    cell = Cell(seed, in_hand)
    station, board = Seeing(cell), np.linalg.inv if in_hand else np.asarray
    return Live(
        cell.arm,
        station,
        lambda joints: board(cell.board_poses(joints)),
        cell.arm.forward,
        station.pictures,
    )


def outcomes(kind: str, sessions: Sequence[Live]) -> None:
    """A row of the table."""
    rows = [len(session.rows) for session in sessions]
    before, after = (
        [getattr(session, what) for session in sessions] for what in ("before", "after")
    )
    ratio = [session.predicted / session.after for session in sessions]
    print(
        f"| {kind} | {np.median(rows):.0f} ({max(rows)})"
        f" | {np.median(before):.1f} mm | {np.median(after):.2f} mm ({max(after):.2f})"
        f" | {np.median(ratio):.1f} ({min(ratio):.1f}) |",
        flush=True,
    )


def end(gears: float) -> None:
    """When eight UR5 end, with a noise of 0.1 mm and 0.01 degrees, and how right they are then."""
    sessions = [kinematic("UR5", seed, gears, ROUGH) for seed in range(8)]
    rows = [len(session.rows) for session in sessions]
    after = [session.after for session in sessions]
    kind = f"UR5, gears eccentric by {np.degrees(gears):.2f} deg"
    print(f"{kind}: rows {sorted(rows)}, median {np.median(rows):g}; largest {max(after):.2f} mm")


if __name__ == "__main__":
    if sys.argv[1:] == ["ur5"]:
        for gears in (0.0, GEARS):
            end(gears)
        sys.exit()
    print(f"{DRAWS} draws each, until the predicted error is {1e3 * ERROR:g} mm or more is no use")
    heads = "arm", "rows (most)", "before", "after (largest)", "predicted over true (least)"
    print(f"| {' | '.join(heads)} |")
    seeds = range(DRAWS)
    for name in ARMS:
        for gears in (0.0, GEARS):
            kind = f"{name}, gears eccentric by {np.degrees(gears):.2f} deg"
            outcomes(kind, [kinematic(name, seed, gears) for seed in seeds])
        for friction in (0.0, FRICTION):
            kind = f"{name} in MuJoCo, friction {friction:g} N m"
            outcomes(kind, [physical(name, seed, friction) for seed in seeds])
    for place in ("beside the arm", "on the hand"):
        kind = f"Panda, camera {place}, until {1e3 * FINER:g} mm"
        outcomes(kind, [pictured(seed, place == "on the hand") for seed in seeds])
