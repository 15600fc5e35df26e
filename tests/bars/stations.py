"""A station with a camera, simulated: corners as its lens maps them, without any pictures."""

import numpy as np

from recalib.station.interface import cells_of
from recalib.station.pictures import PICTURE, BoardInPictures
from recalib.vision import Corners, find_lens
from recalib.vision.boards import FEWEST
from tests.bars.pictures import NOISE
from tests.vision.rendering import Cell

FOR_THE_LENS = 15  # pictures that were taken before, for a lens to begin with


class Seeing:
    """A Panda of a cell; what its camera sees is in `pictures` by its number.

    Attributes:
        unseen: the postures in which the board was not in sight.
    """

    def __init__(self, cell: Cell):
        self.cell, self.joints, model = cell, cell.arm.joints, cell.arm.model
        self.limits = model.lowerPositionLimit, model.upperPositionLimit
        first, *before = cell.postures(1 + FOR_THE_LENS)
        views = [cell.view(pose, NOISE) for pose in cell.board_poses(np.array(before))]
        lens = find_lens([(cell.board, view) for view in views], cell.lens.size).lens
        self.pictures = BoardInPictures(cell.board, lens, cell.in_hand)
        self.stands, self.taken, self.unseen = first, 0, set()

    def move(self, angles, speed):
        self.stands = angles

    def angles(self):
        return self.stands

    def measure(self):
        (pose,) = self.cell.board_poses(self.stands[None])
        view = self.cell.view(pose, NOISE)
        facing = pose[:3, 2] @ pose[:3, 3] / np.linalg.norm(pose[:3, 3])
        inside = ((view.pixels > 0) & (view.pixels < self.cell.lens.size)).all(axis=1)
        if facing < 0.3 or inside.sum() < FEWEST:
            self.unseen.add(tuple(self.stands))
            return None
        self.taken += 1
        corners = Corners(view.numbers[inside], view.pixels[inside], 1.0)
        name = str(self.taken)
        return {PICTURE: name, **cells_of(self.pictures.add(name, corners).pose)}

    def stop(self):
        pass
