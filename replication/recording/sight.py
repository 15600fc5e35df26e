"""The first view of a recording, and places of texts in it."""

from dataclasses import dataclass

import numpy as np

from recalib.nominal.poses import Workspace

HALF = np.tan(np.radians(55 / 2))  # half the height of the viewer's picture, at a distance of 1


@dataclass(frozen=True)
class Sight:
    """The first view of an arm and its workspace."""

    eye: np.ndarray  # (3,) m, position of the eye
    target: np.ndarray  # (3,) m, point in the middle of the picture
    axes: np.ndarray  # (2, 3) m, vectors of half the picture's height, towards the base and up

    def place(self, aside: float, above: float) -> np.ndarray:
        """A point (3,) [m] of the plane that faces the eye, by its place in the picture."""
        return self.target + [aside, above] @ self.axes


def sight_of(workspace: Workspace, misses: np.ndarray) -> Sight:
    """A view from in front of the arm, from the side on which errors (n, 3) [m] look longest."""
    centre = workspace.centre[:3, 3]
    ahead = np.array([*centre[:2], 0]) / np.hypot(*centre[:2])
    up = np.array([0, 0, 1])
    eyes = [0.95 * ahead + side * 1.2 * np.cross(ahead, up) + 0.5 * up for side in (1, -1)]
    eyes = [eye / np.linalg.norm(eye) for eye in eyes]
    eye = max(eyes, key=lambda eye: np.linalg.norm(np.cross(misses, eye), axis=-1).sum())
    aside = np.cross(up, eye)
    axes = np.array([-np.sign(aside @ ahead) * aside, np.cross(eye, aside)])
    away = 1.6 * np.linalg.norm(centre)
    # nearer to the arm than the workspace's centre, to have all of the arm in view
    target = 0.68 * centre + 0.075 * away * up
    half = away * HALF / np.linalg.norm(aside)
    return Sight(eye=target + away * eye, target=target, axes=half * axes)
