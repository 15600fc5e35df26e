"""The HTML page of pictures: the corners in each, and their coverage of lens and workspace."""

from base64 import b64encode

import cv2
import numpy as np
from matplotlib import rc_context

from recalib.laboratory.pictures.observed import WIDE, Observed, Picture
from recalib.laboratory.report.page import COLOURS, STYLE, figure_of, svg_of
from recalib.laboratory.report.templates import render

DOT, COLOUR = 2, (178, 114, 0)  # px, and blue in OpenCV's order (BGR)
QUALITY = 70  # of JPEG


def page_of_pictures(result: Observed) -> bytes:
    return render(
        "pictures.html.j2",
        notes=result.summary().splitlines(),
        pictures=[(picture, _small(picture)) for picture in result.pictures],
        coverage=_coverage(result),
    ).encode()


def _small(picture: Picture) -> str:
    """A small picture with its corners, as JPEG in base64; empty if it could not be read."""
    if picture.small is None or picture.size is None:
        return ""
    small, scale = cv2.cvtColor(picture.small, cv2.COLOR_GRAY2BGR), WIDE / picture.size[0]
    for u, v in () if picture.corners is None else picture.corners.pixels * scale:
        cv2.circle(small, (round(u), round(v)), DOT, COLOUR, 1, cv2.LINE_AA)
    _, content = cv2.imencode(".jpg", small, [cv2.IMWRITE_JPEG_QUALITY, QUALITY])
    return b64encode(content.tobytes()).decode()


@rc_context(STYLE)
def _coverage(result: Observed) -> str:
    """A drawing of all corners on the lens, and of all boards in front of the camera."""
    used = result.used
    pixels = np.concatenate([picture.corners.pixels for picture in used if picture.corners])
    places = np.array([picture.pose[:3, 3] for picture in used if picture.pose is not None])
    figure, (drawn,) = figure_of(3.4, 1, 3)
    wide, high = result.lens.size
    drawn[0].set(title="corners on the lens [px]", xlim=(0, wide), ylim=(high, 0))
    drawn[0].scatter(*pixels.T, s=3, color=COLOURS["after"], linewidth=0, rasterized=True)
    for panel, (across, up) in zip(drawn[1:], ((0, 1), (0, 2)), strict=True):
        panel.set(title=f"the board in the camera, {'xyz'[across]} and {'xyz'[up]} [m]")
        panel.scatter(places[:, across], places[:, up], s=12, color=COLOURS["after"])
    for panel in drawn:
        panel.set_aspect("equal", "datalim" if panel is not drawn[0] else "box")
    return svg_of(figure)
