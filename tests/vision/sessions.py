"""Folders as observe writes them, of corners that nobody had to look for, in one arm's cell."""

import csv
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from recalib.files import write_new
from recalib.laboratory.pictures.observed import Observed, Picture
from recalib.laboratory.tables.table import read_table
from recalib.vision import Corners, Lens, board_pose, find_lens, printable
from tests.vision.rendering import LENS, Cell, frame

PICTURES, NOISE = 30, 0.15  # px
LONGER = Lens((1280, 960), LENS.matrix * [[1.1], [1.1], [1.0]], 0.5 * LENS.distortion)
SMALL = printable(8, 5, 0.03)
SHIFT = frame([0, 0, 0], [6e-4, -6e-4, 5e-4])  # by 1 mm
TURN = frame(np.radians(0.2) * np.array([0.6, -0.6, 0.5]), [0, 0, 0])  # by 0.2 deg


def beside(seed: int) -> Cell:
    """The cell of a fixed camera, as seen by another one that stands to the side of it."""
    cell = Cell(seed, lens=LONGER)
    cell.eye = frame([0, 0, 0.5], [0, 0, 0]) @ cell.eye
    return cell


def write_joints(path: Path, cell: Cell, joints: np.ndarray) -> None:
    """The table, of pictures 000.png and so on."""
    with path.open("w", newline="") as stream:
        writer = csv.writer(stream)
        writer.writerow(["picture", *(f"{name} [rad]" for name in cell.arm.joints)])
        writer.writerows([f"{row:03}.png", *angles] for row, angles in enumerate(joints))


def write_session(
    folder: Path,
    cell: Cell,
    camera: str = "camera",
    board: str = "board",
    slip: tuple[str, np.ndarray] | None = None,
    lens: Lens | None = None,
    pictures: int = PICTURES,
) -> Path:
    """What observe would write to a folder.

    Args:
        slip: `eye` or `sheet`, and the motion (4, 4) [m] in its own frame after half of the rows.
        lens: as given; estimated from the pictures by default.
    """
    cell.random = np.random.default_rng([cell.seed, *camera.encode(), *board.encode()])
    joints = cell.postures(pictures)
    poses = cell.board_poses(joints)
    if slip is not None:
        place, motion = slip
        before = getattr(cell, place)
        setattr(cell, place, before @ motion)
        poses[pictures // 2 :] = cell.board_poses(joints)[pictures // 2 :]
        setattr(cell, place, before)
    views = [cell.view(pose, NOISE) for pose in poses]
    return write_views(folder, cell, joints, views, lens, camera, board)


def write_views(
    folder: Path,
    cell: Cell,
    joints: np.ndarray,
    views: Sequence[Corners],
    given: Lens | None = None,
    camera: str = "camera",
    board: str = "board",
) -> Path:
    """What observe would write to a folder that has these corners in its pictures."""
    own = find_lens([(cell.board, view) for view in views], cell.lens.size)
    lens = given or own.lens
    folder.mkdir(parents=True, exist_ok=True)
    write_joints(folder / "joints.csv", cell, joints)
    table = read_table(folder / "joints.csv")
    observed = [
        Picture(row, name, corners=view, error=0.2, pose=board_pose(cell.board, lens, view))
        for row, (name, view) in enumerate(zip(table.cells["picture"], views, strict=True), 1)
    ]
    result = Observed(table, cell.board, own, given, cell.in_hand, observed, [], camera, board)
    write_new(folder / "observed", result.files())
    return folder / "observed"
