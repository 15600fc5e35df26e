"""Drawing of a board at true size, with a bar to check the printer's scale."""

from io import BytesIO

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path as Outline

from recalib.vision.boards import Board

PAPERS = {"A4": (297, 210), "A3": (420, 297), "A2": (594, 420), "A1": (841, 594), "A0": (1189, 841)}
MARGIN, FOOT = 8.0, 13.0  # mm around the board, and below it for the bar
BAR = 100.0  # mm
INCH = 25.4  # mm


def draw_board(board: Board, *formats: str) -> tuple[list[bytes], tuple[float, float], float]:
    """A board at true size in formats such as pdf and svg; the sizes [mm] of the paper and the bar.

    The paper is the smallest large enough sheet, in landscape format.
    """
    size = 1e3 * board.size
    least = np.add(size, (2 * MARGIN, 2 * MARGIN + FOOT))
    sheets = (sheet for sheet in PAPERS.values() if (least <= sheet).all())
    paper = next(sheets, (float(least[0]), float(least[1])))
    figure = Figure(figsize=(paper[0] / INCH, paper[1] / INCH))
    page = figure.add_axes((0, 0, 1, 1), xlim=(0, paper[0]), ylim=(paper[1], 0))
    page.set_axis_off()
    left = (paper[0] - size[0]) / 2
    black = np.add(_outline(board.modules, size), (left, MARGIN))
    foot = MARGIN + size[1] + FOOT / 2
    bar = np.array([[0, 0], [BAR, 0], [BAR, 2], [0, 2]]) + np.array([left, foot])
    for corners in (black, bar[None]):
        # one outline, since viewers would show seams between separate shapes that touch
        outline = Outline.make_compound_path_from_polys(corners)
        page.add_patch(PathPatch(outline, color="black", linewidth=0))
    text = (
        f"This bar is {BAR:g} mm long unless the printer scaled it. {board.kind}"
        f" {board.columns} x {board.rows}, {1e3 * board.square:g} mm, {board.dictionary}"
    )
    page.text(left, foot + 6, text, fontsize=8)
    contents = []
    for name in formats:
        figure.savefig(content := BytesIO(), format=name)
        contents.append(content.getvalue())
    return contents, paper, BAR


def _outline(black: np.ndarray, size: np.ndarray) -> np.ndarray:
    """Corners (run, 4, 2) [mm] of the horizontal runs of black modules."""
    edges = np.diff(np.pad(black.astype(int), ((0, 0), (1, 1))), axis=1)
    (line, start), (_, end) = np.nonzero(edges == 1), np.nonzero(edges == -1)
    corners = np.stack([[start, line], [end, line], [end, line + 1], [start, line + 1]])
    return corners.transpose(2, 0, 1) * (size / black.shape[::-1])
