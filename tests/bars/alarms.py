"""False alarms for good tables, and which jumps are named: python -m tests.bars.alarms [COUNT].

Tables of ten arms, of 30 to 100 rows, poses or positions, with gears, sag and noise as they come,
in random order or along a path; and a tenth as many sets of pictures of a Panda. At most two of
1,000 good ones may raise an alarm. Where, after any row from 5 to n - 5, the instrument jumps by
five deviations of the noise up to 80 mm and 3 degrees, 95 % should be named within one row. Of
pictures, camera or board jumps, and the deviation is that of corners.
"""

import re
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.spatial.transform import Rotation

from recalib.errors import RecalibError
from recalib.identification.checks.sequence import JUMP, SLIP
from recalib.laboratory.calibrate import Calibrated, calibrate
from recalib.laboratory.pictures.sessions import calibrate_pictures
from recalib.laboratory.report.doubts import doubts
from recalib.vision import Corners
from tests.bars.stated import NAMED, TEXTS, Cell, Setup
from tests.vision import rendering
from tests.vision.sessions import NOISE, write_views

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
        self.cell, self.setup = Cell(setup, seed), setup
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

    def calibrated(self) -> Calibrated:
        return calibrate(self.cell.nominal, self.joints, self.measured)

    def alarms(self) -> list[str]:
        """The error that refuses the table, or the doubts of its calibration; none is good."""
        try:
            result = self.calibrated()
        except RecalibError as error:
            return [str(error)]
        return [doubt for doubt in doubts(result) if POSTURES not in doubt]

    def named(self) -> int | None:
        """The row (from 0) from which on the calibration reports a moved instrument, or None."""
        try:
            result = self.calibrated()
        except RecalibError as error:
            match = re.search(r"between rows (\d+) and", str(error))
            return int(match[1]) if match else None
        return next((fault.row for fault in result.faults if fault.kind in (JUMP, SLIP)), None)


class Pictures(Table):
    """Corners of a board in pictures, in which camera or board may jump."""

    def __init__(self, seed: int):
        self.random = np.random.default_rng([seed, 46])
        self.cell = rendering.Cell(seed, bool(seed % 2))
        self.joints = self.cell.postures(int(self.random.integers(30, 61)))
        self.measured = self.cell.board_poses(self.joints)
        self.setup = "pictures"

    def jump(self) -> int:
        random, cell, count = self.random, self.cell, len(self.joints)
        first, place = int(random.integers(ENDS, count - ENDS + 1)), random.choice(["eye", "sheet"])
        directions = random.standard_normal((2, 3))
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)
        before = getattr(cell, place)

        def moved(distance: float, turn: float = 0.0) -> np.ndarray:
            motion = rendering.frame(turn * directions[1], distance * directions[0])
            setattr(cell, place, before @ motion)
            return cell.board_poses(self.joints)

        shift = np.array([*map(cell.project, moved(1e-4))]) - [*map(cell.project, self.measured)]
        least = 5 * NOISE / np.sqrt(np.mean(shift**2)) * 1e-4
        distance = np.exp(random.uniform(np.log(least), np.log(FARTHEST)))
        turn = TURNED * random.random() ** 2 * (distance > 4 * least) * random.integers(2)
        self.measured[first:] = moved(distance, turn)[first:]
        return first

    def calibrated(self) -> Calibrated:
        views = []
        for pose in self.measured:
            pixels = self.cell.view(pose, NOISE).pixels
            seen = ((pixels > 0) & (pixels < self.cell.lens.size)).all(axis=1)
            views.append(Corners(np.flatnonzero(seen), pixels[seen], 1.0))
        with TemporaryDirectory() as folder:
            observed = write_views(Path(folder), self.cell, self.joints, views)
            return calibrate_pictures("panda.urdf", [observed], tool="panda_link8")


if __name__ == "__main__":
    tables = int(sys.argv[1]) if sys.argv[1:] else 1000
    for kind, count in (Table, tables), (Pictures, tables // 10):
        false_alarms = named_rightly = 0
        for seed in range(count):
            for alarm in kind(seed).alarms()[:1]:
                false_alarms += 1
                print(f"{seed}: {kind(seed).setup}: {alarm}", flush=True)
        print(f"{false_alarms} of {count} good ones are doubted: {kind.__doc__}")
        for seed in range(count // 2):
            table = kind(seed)
            first, row = table.jump(), table.named()
            named_rightly += row is not None and abs(row - first) <= 1
            if row is None or abs(row - first) > 1:
                print(f"{seed}: {table.setup}: row {first}, named {row}", flush=True)
        print(f"{named_rightly} of {count // 2} jumps are named within one row")
