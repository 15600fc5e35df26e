"""What pictures have to show, measured: python -m tests.vision.bars prints the tables.

A Panda off as in docs/peers.md, 30 pictures, lens, camera and board unknown, corners with a noise
of 0.15 px. Errors are those of the arm, in 200 fresh postures, after one shift of base and tool.
"""

from dataclasses import dataclass, replace

import numpy as np

from recalib.identification.calibration import Calibration
from recalib.identification.closed_forms import solutions
from recalib.identification.error_model import OFFSETS, ErrorModel
from recalib.identification.estimation import identify
from recalib.identification.identifiability import unidentifiable_parameters
from recalib.identification.initial_estimate import initial_frames
from recalib.identification.linearisation import displacements
from recalib.identification.observations import Observations
from recalib.identification.repeatability import weigh
from recalib.laboratory.places import found_places
from recalib.vision.detection import Corners
from recalib.vision.views import find_lens, optics_of
from tests.vision.rendering import Cell

PICTURES, FRESH, NOISE = 30, 200, 0.15  # px


@dataclass
class Draw:
    """A cell with corners in pictures, and calibrations of it.

    Attributes:
        returns: deg, how well joints return.
        poses, pixels: observations as those of solvePnP, and weighed by their pixels.
    """

    seed: int
    in_hand: bool
    returns: float = 0.0

    def __post_init__(self):
        self.cell = Cell(self.seed, self.in_hand)
        self.joints, self.fresh = np.split(self.cell.postures(PICTURES + FRESH), [PICTURES])
        off = np.radians(self.returns) * self.cell.random.standard_normal(self.joints.shape)
        self.views = views = [self._view(pose) for pose in self.cell.seen(self.joints + off)]
        self.lens = find_lens(self.cell.board, views, self.cell.lens.size)
        measured, optics = optics_of(self.cell.board, self.lens, views, True, self.in_hand)
        self.poses = Observations(self.joints, measured)
        self.pixels = replace(self.poses, optics=optics)

    def _view(self, pose: np.ndarray) -> Corners:
        pixels = self.cell.project(pose)
        pixels += NOISE * self.cell.random.standard_normal(pixels.shape)
        return Corners(np.arange(len(pixels)), pixels, 0.0)

    def calibration(self, observations: Observations) -> Calibration:
        """By geometry alone."""
        frames = initial_frames(self.cell.arm, self.poses)
        if observations.optics is not None:
            frames = frames.with_optics(observations.optics)
        model = ErrorModel(self.cell.arm, OFFSETS, frames)
        if observations.optics is not None:
            observations = weigh(model, observations)
        return Calibration(model, identify(model, observations))

    def judge(self, poses: np.ndarray) -> tuple[float, np.ndarray]:
        """The mean error [mm] of predicted poses of the tool, and the shift (4, 4) of its base."""
        true = self.cell.tool(self.fresh)
        ends = next(solutions(poses, Observations(self.fresh, true)))
        gaps = (ends.base @ poses @ ends.targets[0] - true)[:, :3, 3]
        return 1e3 * float(np.linalg.norm(gaps, axis=1).mean()), ends.base

    def place(self, calibration: Calibration, shift: np.ndarray) -> float:
        """How far the one of camera and board that stands is off, over its stated deviation."""
        missing = unidentifiable_parameters(calibration, self.pixels)
        there, _ = found_places(calibration, missing, ["moves"], [], self.cell.arm.tool, ["stands"])
        true = self.cell.sheet if self.in_hand else self.cell.eye
        off = displacements((shift @ there.pose)[None], true[None])[0, :3]
        return float(np.linalg.norm(off)) / there.deviations[0]


def errors(in_hand: bool, draws: int) -> np.ndarray:
    """(draw, 4): nominal, by poses, by pixels [mm], and the place over its deviation."""
    rows = []
    for seed in range(draws):
        draw = Draw(seed, in_hand)
        nominal, _ = draw.judge(draw.cell.arm.forward(draw.fresh))
        by_poses, by_pixels = map(draw.calibration, (draw.poses, draw.pixels))
        error, shift = draw.judge(by_pixels.forward(draw.fresh))
        first = draw.judge(by_poses.forward(draw.fresh))[0]
        rows.append([nominal, first, error, draw.place(by_pixels, shift)])
    return np.array(rows)


def main(draws: int = 40) -> None:
    """Print a row for each place of the camera."""
    print("| camera | nominal | by poses | by pixels | largest by pixels | pixels better | place |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    for name, in_hand in (("fixed", False), ("on the hand", True)):
        rows = errors(in_hand, draws)
        nominal, poses, pixels, _ = np.median(rows, axis=0)
        better, within = np.sum(rows[:, 2] < rows[:, 1]), np.sum(rows[:, 3] < 3)
        numbers = f"{nominal:.3g} | {poses:.3g} | {pixels:.3g} | {rows[:, 2].max():.3g}"
        print(f"| {name} | {numbers} | {better} of {draws} | {within} of {draws} |")


if __name__ == "__main__":
    main()
