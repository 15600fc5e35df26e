"""Flange poses whose pictures are most informative about the poses of camera and board.

Candidates are drawn with the flange within a box, the line of sight within a cone about the board's
normal, and the whole board in the picture. Each pose is chosen given the measured poses and those
chosen before it.
"""

from dataclasses import replace
from os import PathLike
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.errors import InvalidFile, RecalibError
from recalib.files.archives import refused
from recalib.files.storage import read_toml
from recalib.identification.hand_eye import ONE_AXIS, information
from recalib.identification.model.hand_eye_model import HandEye, Sights
from recalib.identification.model.linearisation import LEVER
from recalib.laboratory.hand_eye.calibrating import HAND_EYE, POSES
from recalib.laboratory.hand_eye.pose_table import read_poses
from recalib.laboratory.live.allowed import Box
from recalib.laboratory.options import IN_HAND
from recalib.laboratory.pictures.observed import LENS, SETUP
from recalib.numerics.randomness import generator
from recalib.vision.boards import Board, board_in
from recalib.vision.detection import Corners
from recalib.vision.lenses import Lens, read_lens
from recalib.vision.views import optics_of, predicted_views, projected, sighting

DRAWN, TRIED = 400, 40_000  # candidates, and random draws for them
NOISE = 0.1  # px, of corners
BEYOND = 0.1  # m, added on each side of the box of measured poses
MIDDLE = 0.4  # of the picture's width and height: largest offset of the board from its centre


def propose_poses(
    folder: str | PathLike[str], count: int, box: Box | None, cone: float
) -> tuple[np.ndarray, np.ndarray]:
    """Poses (n, 4, 4) of the flange, and the camera's deviation [m] (n + 1,) before and after each.

    These deviations are those of independent errors.

    Args:
        folder: of a hand-eye calibration from pictures.
        box: of the flange's positions in the base (default: the measured box and a little beyond).
        cone: rad, largest angle between the line of sight and the board's normal.

    Raises InvalidFile: not such a folder; RecalibError: the board would be visible in no pose.
    """
    home = Path(folder)
    if not (home / SETUP).is_file():
        raise InvalidFile(folder, "it has no hand-eye calibration by pictures")
    values, setup = read_toml(home / HAND_EYE), read_toml(home / SETUP)
    board, lens = board_in(setup, home / SETUP), read_lens(home / LENS)
    flange, in_hand = read_poses(home / POSES).poses, setup.get("camera") == IN_HAND
    with refused(home / HAND_EYE, "recalib calibrate --poses"):
        camera, target = (np.array(values[name]["matrix"]) for name in ("camera", "board"))
        robot = values["robot"]
        accuracy = np.array([robot["millimetres"] / 1e3, np.radians(robot["degrees"])])
        found = HandEye.at(Sights(flange, flange, in_hand), camera, target)

    def information_at(flange: np.ndarray) -> np.ndarray:
        """The information (n, 12, 12) of pictures at flange poses (n, 4, 4)."""
        views = []
        for pose in found.predict(Sights(flange, flange, in_hand)):
            pixels, _ = projected(board.points, lens, pose)
            view = Corners(np.arange(len(pixels)), pixels, 0.0)
            one = sighting(board, lens, view, False, False, pose)
            views.append(one._replace(squares=NOISE**2 * one.free))
        measured, optics = optics_of(lens, views)
        sights = Sights(flange, measured, in_hand, optics)
        return information(replace(HandEye.at(sights, camera, target), accuracy=accuracy))

    drawn = _drawn(found, board, lens, box, cone)
    each = information_at(drawn)
    scale = np.repeat([1.0, 1 / LEVER, 1.0, 1 / LEVER], 3)
    total = information_at(flange).sum(axis=0) + np.diag(scale**-2.0)
    chosen: list[int] = []
    deviations = [_deviation(total)]
    for _ in range(min(count, len(drawn))):
        variances = np.diagonal(np.linalg.inv(total + each), axis1=1, axis2=2)[:, :6]
        sizes = variances @ np.repeat([1.0, LEVER**2], 3)
        sizes[chosen] = np.inf
        chosen.append(int(sizes.argmin()))
        total = total + each[chosen[-1]]
        deviations.append(_deviation(total))
    return drawn[chosen], np.array(deviations)


def _deviation(information: np.ndarray) -> float:
    """Standard deviation [m] of the camera's position along the worst axis."""
    return float(np.sqrt(np.linalg.eigvalsh(np.linalg.inv(information)[:3, :3])[-1]))


def _drawn(found: HandEye, board: Board, lens: Lens, box: Box | None, cone: float) -> np.ndarray:
    """Random poses (n, 4, 4) of the flange at which the camera would see the board."""
    rng, sights = generator(0, "poses of a flange to measure next"), found.sights
    middle, places = board.points.mean(axis=0), sights.flange[:, :3, 3]
    box = box or Box(places.min(axis=0) - BEYOND, places.max(axis=0) + BEYOND)
    distances = np.linalg.norm((found.predict(sights) @ [*middle, 1.0])[:, :3], axis=1)
    # the board in front of the camera: its middle on a ray, its normal within a cone about the ray
    rays = np.ones((TRIED, 3))
    rays[:, :2] = rng.uniform(-MIDDLE, MIDDLE, (TRIED, 2)) * lens.size / lens.matrix.diagonal()[:2]
    rays /= np.linalg.norm(rays, axis=1)[:, None]
    tilts, about = cone * np.sqrt(rng.uniform(0, 1, TRIED)), rng.uniform(0, 2 * np.pi, TRIED)
    turns = Rotation.from_rotvec(
        tilts[:, None] * np.stack([np.cos(about), np.sin(about), 0 * about], axis=1)
    ) * Rotation.from_rotvec(rng.uniform(-np.pi, np.pi, TRIED)[:, None] * [0, 0, 1])
    boards = np.tile(np.eye(4), (TRIED, 1, 1))
    boards[:, :3, :3] = turns.as_matrix()
    lengths = rng.uniform(distances.min(), distances.max(), TRIED)
    boards[:, :3, 3] = lengths[:, None] * rays - boards[:, :3, :3] @ middle
    boards = boards[np.sum(boards[:, :3, 2] * rays, axis=1) >= np.cos(cone)]
    drawn = found.camera @ boards @ np.linalg.inv(found.board)
    drawn = np.linalg.inv(drawn) if sights.in_hand else drawn
    (_, second, _), axes = sights.axes
    if second < ONE_AXIS:  # the arm turns the flange about one axis only
        angles = rng.uniform(-np.pi, np.pi, len(drawn))[:, None] * axes[0]
        drawn[:, :3, :3] = Rotation.from_rotvec(angles).as_matrix() @ sights.flange[0, :3, :3]
    drawn = drawn[((drawn[:, :3, 3] >= box.low) & (drawn[:, :3, 3] <= box.high)).all(axis=1)]
    drawn = drawn[: 10 * DRAWN]
    shown = found.predict(Sights(drawn, drawn, sights.in_hand))
    _, visible = predicted_views(board, lens, shown, False)
    if not visible.any():
        raise RecalibError("the board would be visible from no pose in the box and cone")
    return drawn[visible][:DRAWN]
