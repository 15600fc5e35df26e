"""What pictures have to show, measured: python -m tests.bars.pictures prints the tables.

A Panda off as in docs/peers.md, 30 pictures, lens, camera and board unknown. In most draws the
corners are projected, with a noise of 0.15 px; in some the pictures are rendered, and the corners
found in them. Errors are those of the arm, in 200 fresh postures, after one shift of base and tool.
"""

from dataclasses import dataclass, replace

import numpy as np

from recalib import OFFSETS, Calibration, Observations, initial_frames
from recalib.identification.checks.identifiability import unidentifiable_parameters
from recalib.identification.checks.scales import returning
from recalib.identification.closed_forms import solutions
from recalib.identification.estimation import identify
from recalib.identification.model.error_model import ErrorModel
from recalib.identification.model.linearisation import displacements
from recalib.laboratory.data_set import DataSet
from recalib.laboratory.places import found_places
from recalib.vision import Corners, find_corners, find_lens, optics_of, sighting
from tests.vision.rendering import Cell

PICTURES, FRESH, NOISE = 30, 200, 0.15  # px


@dataclass
class Draw:
    """A cell with corners in pictures, and calibrations of it.

    Attributes:
        returns: deg, how well joints return.
        rendered: whether corners are found in rendered pictures, blurred, noisy and unevenly lit.
        poses, pixels: observations as those of solvePnP, and weighed by their pixels.
    """

    seed: int
    in_hand: bool
    returns: float = 0.0
    rendered: bool = False

    def __post_init__(self):
        self.cell = Cell(self.seed, self.in_hand)
        self.joints, self.fresh = np.split(self.cell.postures(PICTURES + FRESH), [PICTURES])
        deviations = np.radians(self.returns) * self.cell.random.standard_normal(self.joints.shape)
        self.views = views = [
            self._view(pose) for pose in self.cell.board_poses(self.joints + deviations)
        ]
        self.lens = find_lens([(self.cell.board, view) for view in views], self.cell.lens.size).lens
        measured, optics = optics_of(
            self.lens,
            [sighting(self.cell.board, self.lens, view, True, self.in_hand) for view in views],
        )
        self.poses = Observations(self.joints, measured)
        self.pixels = replace(self.poses, optics=optics)

    def _view(self, pose: np.ndarray) -> Corners:
        if self.rendered:
            return find_corners(self.cell.board, self.cell.picture(pose))
        return self.cell.view(pose, NOISE)

    def calibration(self, observations: Observations) -> Calibration:
        """By geometry alone."""
        frames = initial_frames(self.cell.arm, self.poses)
        if observations.optics is not None:
            frames = frames.with_optics(observations.optics)
        model = ErrorModel(self.cell.arm, OFFSETS, frames)
        if observations.optics is not None:
            observations = observations.with_noise(returning(model, observations))
        return Calibration(model, identify(model, observations))

    def judge(self, poses: np.ndarray) -> tuple[float, np.ndarray]:
        """The mean error [mm] of predicted poses of the tool, and the shift (4, 4) of its base."""
        true = self.cell.tool(self.fresh)
        frames = next(solutions(poses, Observations(self.fresh, true)))
        gaps = (frames.base @ poses @ frames.targets[0] - true)[:, :3, 3]
        return 1e3 * float(np.linalg.norm(gaps, axis=1).mean()), frames.base

    def place(self, calibration: Calibration, shift: np.ndarray) -> float:
        """How far the one of camera and board that stands is off, over its stated deviation."""
        unknown = unidentifiable_parameters(calibration, self.pixels)
        data = DataSet(self.pixels, ("moves",), instruments=("stands",))
        place, _ = found_places(calibration, unknown, data, self.cell.arm.tool)
        true = self.cell.sheet if self.in_hand else self.cell.eye
        error = displacements((shift @ place.pose)[None], true[None])[0, :3]
        return float(np.linalg.norm(error)) / place.deviations[0]


def errors(in_hand: bool, draws: int, rendered: bool) -> np.ndarray:
    """(draw, 5): nominal without and with the shift, by poses, by pixels [mm]; the place.

    The place is its error over its stated deviation.
    """
    rows = []
    for seed in range(draws):
        draw = Draw(seed, in_hand, rendered=rendered)
        expected = draw.cell.arm.forward(draw.fresh)
        gaps = (expected - draw.cell.tool(draw.fresh))[:, :3, 3]
        by_poses, by_pixels = map(draw.calibration, (draw.poses, draw.pixels))
        error, shift = draw.judge(by_pixels.forward(draw.fresh))
        first = draw.judge(by_poses.forward(draw.fresh))[0]
        unshifted = 1e3 * np.linalg.norm(gaps, axis=1).mean()
        place = draw.place(by_pixels, shift)
        rows.append([unshifted, draw.judge(expected)[0], first, error, place])
    return np.array(rows)


def main(draws: int = 40, rendered_draws: int = 4) -> None:
    """Print a row for each place of the camera, of projected corners and of rendered pictures."""
    print(
        "| camera | corners | nominal, no shift | nominal | by poses | by pixels"
        " | largest by pixels | pixels better | place |"
    )
    print("|" + " --- |" * 9)
    kinds = (False, "projected", draws), (True, "in rendered pictures", rendered_draws)
    for rendered, kind, count in kinds:
        for name, in_hand in (("fixed", False), ("on the hand", True)):
            rows = errors(in_hand, count, rendered)
            medians = " | ".join(f"{median:.3g}" for median in np.median(rows, axis=0)[:-1])
            better, within = np.sum(rows[:, 3] < rows[:, 2]), np.sum(rows[:, 4] < 3)
            numbers = f"{medians} | {rows[:, 3].max():.3g}"
            sums = f"{better} of {count} | {within} of {count}"
            print(f"| {name} | {kind} | {numbers} | {sums} |", flush=True)


if __name__ == "__main__":
    main()
