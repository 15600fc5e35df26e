"""Hand-eye calibration next to OpenCV's five solvers: python -m tests.bars.hand_eye.

They are in OpenCV 4 alone: pip install --target FOLDER 'opencv-contrib-python-headless<5', and call
this with PYTHONPATH=FOLDER. All get the same flange poses and the same corners, by the same lens,
which is found from the pictures. The board's place is the mean over pictures, by each solver's
camera. Errors are root mean squares of corners in 40 further pictures, whose flange poses are off,
too. The floor is what the true camera, board and lens leave there, of which no solver is guilty:
the excess is the rest, over that of the one solver of OpenCV that is best over all draws. For
ratios, the best is chosen anew in each draw, by these very pictures.
"""

import sys

import cv2
import numpy as np
from scipy.spatial.transform import Rotation

from recalib.identification.hand_eye import calibrate_hand_eye
from recalib.identification.model.hand_eye_model import Sights
from recalib.identification.model.linearisation import displacements
from recalib.identification.model.optics import BOARD
from recalib.vision import find_corners, find_lens, optics_of, projected, sighting
from recalib.vision.lens_search import moved_lens
from tests.vision.hand_eye_cells import HandEyeCell
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


def draw(cell: HandEyeCell, pictures: int, rendered: bool, wrong: int) -> list[float]:
    """The place over its deviation; held-out errors [px]: own, the floor, and OpenCV's.

    Args:
        wrong: how many rows have the pose of the row before.
    """
    flange = cell.flange(pictures + FRESH)
    flanges, views = cell.reported(flange), cell.views(flange)
    flanges[1 : wrong + 1] = flanges[:wrong].copy()
    if rendered:
        images = [cell.draw(pose) for pose in cell.board_poses(flange[:pictures])]
        views[:pictures] = [find_corners(cell.board, picture) for picture in images]
    lens = find_lens([(cell.board, view) for view in views[:pictures]], cell.lens.size).lens
    sightings = [sighting(cell.board, lens, view, True, False) for view in views[:pictures]]
    board, optics = optics_of(lens, sightings)
    height = (float(cell.target[2, 3]), 1e-4) if cell.four_axes else None
    sights = Sights(flanges[:pictures], board, cell.in_hand, optics, height)
    calibration = calibrate_hand_eye(sights)
    own_lens = moved_lens(lens, calibration.optics[len(BOARD) :]) or lens

    def error(camera, board, lens):
        between = np.linalg.inv(flanges) if cell.in_hand else flanges
        squares = []
        for view, pose in zip(views[pictures:], between[pictures:], strict=True):
            expected, _ = projected(cell.board.points, lens, np.linalg.inv(camera) @ pose @ board)
            squares.append(np.sum((view.pixels - expected) ** 2, axis=1).mean())
        return float(np.sqrt(np.mean(squares)))

    camera_error = displacements(calibration.camera[None], cell.camera[None])[0, :3]
    own = error(calibration.camera, calibration.board, own_lens)
    floor = error(cell.camera, cell.target, cell.lens)
    solvers = [] if cell.four_axes else SOLVERS
    opencv = [error(*by_opencv(sights, solver), lens) for solver in solvers]
    return [float(np.linalg.norm(camera_error) / calibration.deviations(0)[0]), own, floor, *opencv]


def main(draws: int = 20, rendered: bool = False) -> None:
    """Print a row for each cell and number of pictures."""
    names = "px", "OpenCV", "floor", "ratio, median", "largest", "of the floor", "excess"
    print("|", " | ".join(("cell", "pictures", *names, "place within three")), "|")
    print("|" + " --- |" * 10)
    for name, (cell, options) in CELLS.items():
        for pictures in (15, 30):
            wrong = pictures // 10 if "wrong" in name else 0
            rows = [draw(cell(seed, **options), pictures, rendered, wrong) for seed in range(draws)]
            place, own, floor, *opencv = np.array(rows).T
            solver_errors = np.array(opencv) if opencv else np.full((1, draws), np.nan)
            best = solver_errors.min(axis=0)
            ratio, lowest = own / best, np.median(floor / best)
            beyond = np.sum(np.array([own, *solver_errors]) ** 2 - floor**2, axis=1)
            excess = np.sqrt(beyond[0] / beyond[1:].min())
            numbers = [*(np.median(px) for px in (own, best, floor, ratio)), ratio.max()]
            cells = " | ".join(f"{number:.3g}" for number in (*numbers, lowest, excess))
            print(f"| {name} | {pictures} | {cells} | {np.sum(place < 3)} of {draws} |", flush=True)


if __name__ == "__main__":
    rendered = "--rendered" in sys.argv
    main(4 if rendered else 20, rendered)
