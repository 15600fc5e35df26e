"""Hand-eye calibration next to OpenCV's five solvers: python -m tests.bars.hand_eye.

They are in OpenCV 4 alone: pip install --target FOLDER 'opencv-contrib-python-headless<5', and call
this with PYTHONPATH=FOLDER. All get the same flange poses, corners, and lens found from the
pictures. The board's place is the mean over pictures, by each solver's camera. Errors are root mean
squares of corners in 40 further pictures, whose flange poses are off, too. The floor is what the
true camera, board and lens leave there, of which no solver is guilty: the excess is the rest, over
that of the one solver of OpenCV that is best over all draws. For ratios, the best is chosen anew in
each draw, by these very pictures. So no estimator stays below 1.05 of it in all draws: the last
column counts those in which recalib, an ideal estimator that knows lens, print, noise and wrong
rows, and the floor are above.
"""

import sys

import cv2
import numpy as np
from scipy.linalg import block_diag
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from recalib.identification.hand_eye import calibrate_hand_eye
from recalib.identification.model.hand_eye_model import Sights
from recalib.identification.model.linearisation import displaced, displacements
from recalib.identification.model.optics import BOARD
from recalib.laboratory.hand_eye.calibrating import seen, with_lens
from recalib.vision import find_corners, projected
from recalib.vision.lens_search import moved_lens
from tests.vision.hand_eye_cells import NOISE, HandEyeCell, shown_by, turned
from tests.vision.rendering import Cell

FRESH = 40
SOLVERS = [getattr(cv2, f"CALIB_HAND_EYE_{name}") for name in (
    "TSAI", "PARK", "HORAUD", "ANDREFF", "DANIILIDIS")]  # fmt: skip


class PandaCell(HandEyeCell):
    """The same with the postures of a Panda; a camera next to it is 1.3 m away."""

    def __post_init__(self):
        super().__post_init__()
        self.arm = Cell(self.seed, self.in_hand)
        self.camera, self.target = self.arm.eye, self.arm.sheet

    def flange(self, count: int) -> np.ndarray:
        return self.arm.tool(self.arm.postures(count))


CELLS = {
    "Panda, camera next to it": (PandaCell, {"in_hand": False}),
    "Panda, camera on the hand": (PandaCell, {"in_hand": True}),
    "six axes, camera next to the arm": (HandEyeCell, {"in_hand": False}),
    "six axes, camera on the hand": (HandEyeCell, {"in_hand": True}),
    "six axes, 1 of 10 rows wrong": (HandEyeCell, {"in_hand": True}),
    "SCARA, camera on the hand": (HandEyeCell, {"in_hand": True, "four_axes": True}),
    "SCARA, camera next to the arm": (HandEyeCell, {"in_hand": False, "four_axes": True}),
}


def by_opencv(sights: Sights, solver: int) -> tuple[np.ndarray, np.ndarray]:
    """Camera and board (4, 4) by one of OpenCV's solvers."""
    arm = np.linalg.inv(sights.between)
    parts = arm[:, :3, :3], arm[:, :3, 3], sights.board[:, :3, :3], sights.board[:, :3, 3]
    frames = np.tile(np.eye(4), (2, 1, 1))
    frames[0, :3, :3], place = cv2.calibrateHandEye(*map(list, parts), method=solver)
    frames[0, :3, 3] = place.ravel()
    boards = arm @ frames[0] @ sights.board
    frames[1, :3, :3] = Rotation.from_matrix(boards[:, :3, :3]).mean().as_matrix()
    frames[1, :3, 3] = boards[:, :3, 3].mean(axis=0)
    return frames[0], frames[1]


def ideal(cell: HandEyeCell, flanges: np.ndarray, views: list) -> tuple[np.ndarray, np.ndarray]:
    """The most likely camera and board (4, 4), by the true lens, print and noise."""
    sizes = np.repeat([cell.position, cell.rotation], 3)

    def ends(free):
        return displaced(cell.camera, free[:6]), displaced(cell.target, free[6:12])

    def residuals(free):
        camera, board = ends(free)
        errors = free[12:].reshape(-1, 6)
        between = flanges @ np.linalg.inv(turned(*np.split(errors * sizes, 2, axis=1)[::-1]))
        if cell.in_hand:
            between = np.linalg.inv(between)
        poses = np.linalg.inv(camera) @ between @ board
        rows = []
        for view, pose, error in zip(views, poses, errors, strict=True):
            pixels, _ = projected(cell.board.points[view.numbers], cell.lens, pose)
            rows += [error, (view.pixels - pixels).ravel() / NOISE]
        return np.concatenate(rows)

    own = block_diag(*(np.ones((6 + 2 * len(view.numbers), 6)) for view in views))
    sparsity = np.hstack([np.ones((len(own), 12)), own])
    start = np.zeros(sparsity.shape[1])
    return ends(least_squares(residuals, start, jac_sparsity=sparsity, x_scale="jac").x)


def draw(cell: HandEyeCell, pictures: int, rendered: bool, wrong: int) -> list[float]:
    """The place over its deviation; held-out errors [px]: own, ideal, the floor, and OpenCV's.

    Args:
        wrong: how many rows have the pose of the row before.
    """
    flange = cell.flange(pictures + FRESH)
    flanges, views = cell.reported(flange), cell.views(flange)
    flanges[1 : wrong + 1] = flanges[:wrong].copy()
    if rendered:
        images = [cell.draw(pose) for pose in cell.board_poses(flange[:pictures])]
        views[:pictures] = [find_corners(cell.board, picture) for picture in images]
    shown = shown_by(cell, views[:pictures])
    height = (float(cell.target[2, 3]), 1e-4) if cell.four_axes else None
    sights = seen(shown, flanges[:pictures], height)
    near, calibration = with_lens(shown, calibrate_hand_eye(sights))
    own_lens = moved_lens(near.lens, calibration.optics[len(BOARD) :]) or near.lens
    printed = 1 + np.append(calibration.optics[: len(BOARD)], 0.0)

    def error(camera, board, lens, scale=1.0):
        between = np.linalg.inv(flanges) if cell.in_hand else flanges
        points, squares = scale * cell.board.points, []
        for view, pose in zip(views[pictures:], between[pictures:], strict=True):
            expected, _ = projected(points, lens, np.linalg.inv(camera) @ pose @ board)
            squares.append(np.sum((view.pixels - expected) ** 2, axis=1).mean())
        return float(np.sqrt(np.mean(squares)))

    camera_error = displacements(calibration.camera[None], cell.camera[None])[0, :3]
    place = float(np.linalg.norm(camera_error) / calibration.deviations(0)[0])
    own = error(calibration.camera, calibration.board, own_lens, printed)
    right = np.r_[0, wrong + 1 : pictures]
    likely = error(*ideal(cell, flanges[right], [views[row] for row in right]), cell.lens)
    floor = error(cell.camera, cell.target, cell.lens)
    solvers = [] if cell.four_axes else SOLVERS
    opencv = [error(*by_opencv(sights, solver), shown.lens) for solver in solvers]
    return [place, own, likely, floor, *opencv]


def main(draws: int = 20, rendered: bool = False) -> None:
    """Print a row for each cell and number of pictures."""
    names = "cell", "pictures", "px", "OpenCV", "floor", "ratio, median", "largest", "of the ideal"
    names += "of the floor", "excess", "place within three", "above 1.05: recalib, ideal, floor"
    print("|", " | ".join(names), "|")
    print("|" + " --- |" * len(names))
    for name, (cell, options) in CELLS.items():
        for pictures in (15, 30):
            wrong = pictures // 10 if "wrong" in name else 0
            rows = [draw(cell(seed, **options), pictures, rendered, wrong) for seed in range(draws)]
            place, own, likely, floor, *opencv = np.array(rows).T
            solver_errors = np.array(opencv) if opencv else np.full((1, draws), np.nan)
            best = solver_errors.min(axis=0)
            ratio, *others = (px / best for px in (own, likely, floor))
            beyond = np.sum(np.array([own, *solver_errors]) ** 2 - floor**2, axis=1)
            excess = np.sqrt(beyond[0] / beyond[1:].min())
            numbers = [*(np.median(px) for px in (own, best, floor, ratio)), ratio.max()]
            numbers += [*map(np.median, others), excess]
            cells = " | ".join(f"{number:.3g}" for number in numbers)
            above = ", ".join(str(np.sum(each > 1.05)) for each in (ratio, *others))
            counts = f"{np.sum(place < 3)} of {draws} | {above if opencv else np.nan}"
            print(f"| {name} | {pictures} | {cells} | {counts} |", flush=True)


if __name__ == "__main__":
    rendered = "--rendered" in sys.argv
    main(4 if rendered else 20, rendered)
