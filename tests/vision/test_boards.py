"""Boards on paper and in TOML, and lenses in YAML."""

from io import BytesIO

import cv2
import numpy as np
import pytest
import yaml
from pypdf import PdfReader

from recalib import InvalidFile
from recalib.vision import (
    Board,
    Corners,
    Unusable,
    board_pose,
    draw_board,
    find_corners,
    printable,
    read_lens,
)
from tests.vision.rendering import LENS, frame

DOTS = 100  # an inch, of Matplotlib's PNG
BOARDS = {
    "charuco": printable(7, 5, 0.036),
    "apriltag": Board("apriltag", 6, 4, 0.04, 0.032, "APRILTAG_36H11"),
}


def grey(png: bytes) -> np.ndarray:
    return cv2.imdecode(np.frombuffer(png, dtype=np.uint8), cv2.IMREAD_GRAYSCALE)


@pytest.mark.parametrize("board", BOARDS.values(), ids=BOARDS)
def test_a_board_is_printed_at_true_size(board):
    (pdf, svg, png), *sizes = draw_board(board, "pdf", "svg", "png")
    assert sizes == [(297, 210), 100]
    paper = [float(side) * 25.4 / 72 for side in PdfReader(BytesIO(pdf)).pages[0].mediabox[2:]]
    assert paper == pytest.approx([297, 210], abs=0.01)
    assert b'width="841.88' in svg and b"100 mm" in svg
    found = find_corners(board, grey(png))
    assert len(found.numbers) == len(board.points)
    expected = board.points[found.numbers, :2] / 0.0254 * DOTS
    gaps = found.pixels - expected
    assert np.abs(gaps - gaps.mean(axis=0)).max() < 0.7  # px, a fifth of a millimetre


SIZE = dict(zip(("width", "height"), LENS.size, strict=True))
FX, FY, CX, CY = FOCAL = LENS.matrix[[0, 1, 0, 1], [0, 1, 2, 2]].tolist()
RADIAL, FOUR = LENS.distortion[:4].tolist(), [0.05, -0.01, 0.003, -0.001]
FIVE, RATIONAL = [*RADIAL, 0.01], [0.3, -0.1, 1e-3, -5e-4, 0.02, 0.45, -0.05, 0.01]


def ros(model: str, own: list[float]) -> str:
    """A message, as `ros2 topic echo` prints it."""
    lens = {"distortion_model": model, "d": own, "k": [FX, 0.0, CX, 0.0, FY, CY, 0.0, 0.0, 1.0]}
    return f"header:\n  frame_id: a\n{yaml.dump(SIZE | lens)}---\n"


def opencv(own: list[float]) -> str:
    storage = cv2.FileStorage("lens.yaml", cv2.FILE_STORAGE_WRITE | cv2.FILE_STORAGE_MEMORY)
    for side, pixels in SIZE.items():
        storage.write(f"image_{side}", pixels)
    storage.write("camera_matrix", LENS.matrix)
    storage.write("distortion_coefficients", np.array(own))
    return storage.releaseAndGetString()


def kalibr(model: str, own: list[float]) -> dict:
    lens = {"distortion_model": model, "distortion_coeffs": own, "camera_model": "pinhole"}
    return lens | {"intrinsics": FOCAL, "resolution": [*LENS.size]}


def realsense(model: str, own: list[float]) -> str:
    focal = dict(zip(("fx", "fy", "ppx", "ppy"), FOCAL, strict=True))
    return yaml.dump({**SIZE, **focal, "model": model, "coeffs": own})


CHAIN = yaml.dump({"cam0": kalibr("radtan", RADIAL) | {"rostopic": "/cam0/image_raw"}})
PRINTED = f"""Width:\t{LENS.size[0]}\nHeight:\t{LENS.size[1]}\nPPX:\t{CX}\nPPY:\t{CY}\nFx:\t{FX}
Fy:\t{FY}\nDistortion:\tInverse Brown Conrady\nCoeffs:\t0  \t0  \t0  \t0  \t0\n"""
WRITTEN = {  # by program and model: what it writes, and the coefficients
    "ros, plumb_bob": (ros("plumb_bob", FIVE), FIVE),
    "ros, rational_polynomial": (ros("rational_polynomial", RATIONAL), RATIONAL),
    "ros, equidistant": (ros("equidistant", FOUR), FOUR),
    **{f"opencv, {len(own)}": (opencv(own), own) for own in (RADIAL, FIVE, RATIONAL)},
    "kalibr, a chain": (CHAIN, RADIAL),
    "kalibr, none": (yaml.dump(kalibr("none", [])), [0.0] * 4),
    "kalibr, equidistant": (yaml.dump(kalibr("equidistant", FOUR)), FOUR),
    "realsense, Brown Conrady": (realsense("Brown Conrady", FIVE), FIVE),
    "realsense, as its library names it": (realsense("distortion.brown_conrady", FIVE), FIVE),
    "realsense, Kannala Brandt4": (realsense("Kannala Brandt4", FOUR), FOUR),
    "realsense, printed": (PRINTED, [0.0] * 4),
}


def pixels_of(own: list[float], points: np.ndarray) -> np.ndarray:
    """Pixels (n, 2) of points (n, 3) by the formulas in the manuals of these programs."""
    x, y = points[:, 0] / points[:, 2], points[:, 1] / points[:, 2]
    square = x**2 + y**2
    if own is FOUR:  # of a fisheye
        r = np.sqrt(square)
        angle = np.arctan(r)
        powers = sum(k * angle ** (2 * n) for n, k in enumerate(own, 1))
        x, y = (part * angle * (1 + powers) / r for part in (x, y))
    else:
        k1, k2, p1, p2, k3, k4, k5, k6 = [*own, 0, 0, 0, 0][:8]
        radial = 1 + k1 * square + k2 * square**2 + k3 * square**3
        radial /= 1 + k4 * square + k5 * square**2 + k6 * square**3
        x, y = (
            x * radial + 2 * p1 * x * y + p2 * (square + 2 * x**2),
            y * radial + p1 * (square + 2 * y**2) + 2 * p2 * x * y,
        )
    return np.stack([FX * x + CX, FY * y + CY], axis=1)


@pytest.mark.parametrize(("text", "own"), WRITTEN.values(), ids=WRITTEN)
def test_a_picture_is_what_the_lens_of_another_program_shows(text, own, tmp_path):
    """The corners of a board that is drawn by the program's own formula have its pose."""
    (tmp_path / "lens.yaml").write_text(text)
    lens, board = read_lens(tmp_path / "lens.yaml"), BOARDS["charuco"]
    assert lens.size == LENS.size
    pose = frame([0.3, -0.4, 0.2], [-0.1, -0.06, 0.35])
    pixels = pixels_of(own, board.points @ pose[:3, :3].T + pose[:3, 3])
    found = board_pose(board, lens, Corners(np.arange(len(pixels)), pixels, 1.0))
    assert found == pytest.approx(pose, abs=1e-6)


ROS = LENS.as_ros()


@pytest.mark.parametrize(
    ("text", "change", "message"),
    [
        (CHAIN, "cam0|camera_0", "are not numbers of pixels"),
        (CHAIN, "pinhole|omni", "camera_model is 'omni'; expected: pinhole"),
        (CHAIN, "radtan|fov", "its model is 'fov'; expected: radtan, equidistant, none"),
        (CHAIN, "intrinsics|focal", "it is not a lens: 'intrinsics'"),
        (realsense("Inverse Brown Conrady", FIVE), "|", "its model is 'inverse brown conrady'"),
        (ROS, "plumb_bob|thin_prism", "distortion_model is 'thin_prism'; expected: one of plumb_b"),
        (ROS, "plumb_bob|equidistant", "needs 4 numbers for equidistant"),
        (ROS, "1105, 0,|.nan, 0,", "camera_matrix needs 9 numbers"),
        (ROS, "1105, 0,|-1105, 0,", "focal lengths are -1105 and 1102; expected: 64 to 64000 px"),
        (ROS, "1105, 0,|4.2, 0,", "its focal lengths are 4.2 and 1102; expected: 64 to 64000 px"),
        (ROS, "1105, 0,|1105, 3,", "expected: fx 0 cx 0 fy cy 0 0 1"),
        (ROS, "0, 0, 1]|0, 0, 2]", "expected: fx 0 cx 0 fy cy 0 0 1"),
        (ROS, "image_width|width_of", "image_width and image_height are not numbers"),
        (ROS, "width: 1280|width: wide", "image_width and image_height are not numbers"),
        (ROS, "width: 1280|width: 0", "image_width and image_height are not numbers"),
        (ROS, "width: 1280|width: 1280.5", "image_width and image_height are not numbers"),
        (ROS, "distortion_coefficients|distortions", "needs 4 or 5 numbers"),
        (ROS, "camera_matrix|matrix", "camera_matrix needs 9 numbers"),
        (ROS, "-0.21|.nan", "needs 4 or 5 numbers"),
        (ROS, "distortion_model: plumb_bob|distortion_model: [a]", "distortion_model is ['a']"),
        (ROS, "[1105|[[1105", "it is not a YAML"),
        pytest.param(ROS, "[1105|" + 10_000 * "[", "it is not a YAML", id="deep"),
    ],
)
def test_a_lens_that_is_none_is_refused(text, change, message, tmp_path):
    (tmp_path / "lens.yaml").write_text(text.replace(*change.split("|")))
    with pytest.raises(InvalidFile, match=message.replace("[", r"\[")):
        read_lens(tmp_path / "lens.yaml")


@pytest.mark.parametrize("size", [(7, 5, 0.036), (5, 3, 0.06), (5, 4, 0.048)])
def test_the_bar_below_a_board_is_100_mm_long(size):
    board = printable(*size)
    (png,), (wide, high), _ = draw_board(board, "png")
    page = grey(png)
    assert high - 1e3 * board.size[1] >= 2 * 8 + 13  # mm
    assert np.divide(page.shape, DOTS / 25.4) == pytest.approx([high, wide], abs=0.3)
    below = round((8 + 1e3 * board.size[1] + 2) * DOTS / 25.4)  # px
    dark = page[below:] < 128
    longest = dark.sum(axis=1).max()
    (rows,) = np.nonzero(dark.sum(axis=1) == longest)
    (columns,) = np.nonzero(dark[rows[0]])
    assert np.ptp(columns) + 1 == longest  # one piece
    assert longest * 25.4 / DOTS == pytest.approx(100, abs=0.3)
    assert np.ptp(rows) * 25.4 / DOTS == pytest.approx(2, abs=0.4)
    assert columns[0] * 25.4 / DOTS == pytest.approx((wide - 1e3 * board.size[0]) / 2, abs=0.3)


def test_a_lens_is_written_as_ros_reads_it():
    written = yaml.safe_load(LENS.as_ros())
    (fx, _, cx), (_, fy, cy), _ = LENS.matrix.tolist()
    assert (written["image_width"], written["image_height"]) == LENS.size
    assert written["distortion_model"] == "plumb_bob"
    for name, rows, columns, data in (
        ("camera_matrix", 3, 3, LENS.matrix.ravel().tolist()),
        ("distortion_coefficients", 1, 5, [*LENS.distortion.tolist(), 0]),
        ("rectification_matrix", 3, 3, [1, 0, 0, 0, 1, 0, 0, 0, 1]),
        ("projection_matrix", 3, 4, [fx, 0, cx, 0, 0, fy, cy, 0, 0, 0, 1, 0]),
    ):
        assert written[name] == {"rows": rows, "cols": columns, "data": pytest.approx(data)}


def test_four_markers_are_enough_and_eight_corners_are_needed():
    board = printable(7, 5, 0.036)
    picture = np.kron(np.where(board.modules, 0, 255), np.ones((12, 12))).astype(np.uint8)
    square = picture.shape[1] // 7
    for columns, corners in ((3, 8), (2, 4)):
        part, border = picture[:, : columns * square], (*4 * [50], cv2.BORDER_CONSTANT)
        part = cv2.copyMakeBorder(part, *border, value=255)
        if corners < 8:
            with pytest.raises(Unusable, match=f"it shows {corners} corners; expected: at least 8"):
                find_corners(board, part)
        else:
            assert len(find_corners(board, part).numbers) == corners
