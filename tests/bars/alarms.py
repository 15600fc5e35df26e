"""False alarms for good tables, and which jumps are named: python -m tests.bars.alarms [COUNT].

Tables of ten arms, of 30 to 100 rows, poses or positions, with gears, sag and noise as they come,
in random order or along a path. At most two of 1,000 good ones may raise an alarm. Where, after any
row from 5 to n - 5, the instrument jumps by five deviations of the noise up to 80 mm and 3 degrees,
95 % should be named within one row.
"""

import re
import sys

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.spatial.transform import Rotation

from recalib.errors import RecalibError
from recalib.identification.checks.sequence import JUMP
from recalib.laboratory.calibrate import calibrate
from recalib.laboratory.report.doubts import doubts
from tests.bars.stated import NAMED, TEXTS, Cell, Setup

ENDS, FARTHEST, TURNED = 5, 0.08, np.radians(3)  # rows, m, rad
POSTURES = "so these results hold only for such postures"  # of arms with few joints: no alarm


class Table:
    """A generated table of a healthy arm, in which the instrument may jump."""

    def __init__(self, seed: int):
        self.random = random = np.random.default_rng([seed, 45])
        names = [*NAMED, *TEXTS]
        soft = random.random() < 0.5
        setup = Setup(
            names[seed % len(names)],
            positions=bool(random.integers(2)),
            rows=int(random.integers(30, 101)),
            half=random.uniform(0.5, 1.5),
            gears=1e-3 * random.random() * soft,
            sag=2e-3 * random.random() * soft,
            noise=np.exp(random.uniform(np.log(0.5), np.log(4))),
        )
        self.cell = Cell(setup, seed)
        joints = self.cell.joints(setup.rows)
        if random.random() < 0.3:
            knots = joints[: max(setup.rows // 4, 5)]
            along = CubicSpline(np.linspace(0, 1, len(knots)), knots)
            joints = np.clip(along(np.linspace(0, 1, setup.rows)), *self.cell.box)
        self.joints, self.measured = joints, self.cell.measured(joints)

    def jump(self) -> int:
        """Let the instrument jump; from which row (from 0) on is returned."""
        random, noise, count = self.random, self.cell.noise[0], len(self.joints)
        first = int(random.integers(ENDS, count - ENDS + 1))
        directions = random.standard_normal((2, 3))
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)
        distance = np.exp(random.uniform(np.log(5 * noise), np.log(FARTHEST)))
        turn = TURNED * random.random() ** 2 * (distance > 20 * noise) * random.integers(2)
        motion = np.eye(4)
        motion[:3, :3] = Rotation.from_rotvec(turn * directions[1]).as_matrix()
        places = self.measured if self.cell.setup.positions else self.measured[:, :3, 3]
        middle = places.mean(axis=0)
        motion[:3, 3] = distance * directions[0] + middle - motion[:3, :3] @ middle
        if self.cell.setup.positions:
            self.measured[first:] = self.measured[first:] @ motion[:3, :3].T + motion[:3, 3]
        else:
            self.measured[first:] = motion @ self.measured[first:]
        return first

    def alarms(self) -> list[str]:
        """The error that refuses the table, or the doubts of its calibration; none is good."""
        try:
            result = calibrate(self.cell.nominal, self.joints, self.measured)
        except RecalibError as error:
            return [str(error)]
        return [doubt for doubt in doubts(result) if POSTURES not in doubt]

    def named(self) -> int | None:
        """The row (from 0) from which on the calibration reports a moved instrument, or None."""
        try:
            result = calibrate(self.cell.nominal, self.joints, self.measured)
        except RecalibError as error:
            match = re.search(r"between rows (\d+) and", str(error))
            return int(match[1]) if match else None
        return next((fault.row for fault in result.faults if fault.kind == JUMP), None)


if __name__ == "__main__":
    tables = int(sys.argv[1]) if sys.argv[1:] else 1000
    false_alarms = 0
    for seed in range(tables):
        for alarm in Table(seed).alarms()[:1]:
            false_alarms += 1
            print(f"{seed}: {Table(seed).cell.setup}: {alarm}", flush=True)
    print(f"{false_alarms} of {tables} good tables are doubted")
    named_rightly = 0
    for seed in range(tables // 2):
        table = Table(seed)
        first = table.jump()
        row = table.named()
        named_rightly += row is not None and abs(row - first) <= 1
        if row is None or abs(row - first) > 1:
            print(f"{seed}: {table.cell.setup}: row {first}, named {row}", flush=True)
    print(f"{named_rightly} of {tables // 2} jumps are named within one row")
