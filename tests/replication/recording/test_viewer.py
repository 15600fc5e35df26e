"""The viewer leaves nothing in a home, is started in one way alone, and takes pictures."""

import os
import subprocess
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from replication.recording import ARM, BEFORE, ends, take_pictures
from replication.recording.viewer import PROGRAM, quiet

FOLDERS = "/usr/share/vulkan/icd.d", "/etc/vulkan/icd.d"
DRIVERS = [path for folder in FOLDERS for path in Path(folder).glob("*.json")]
DRIVERS += filter(None, [os.environ.get("VK_ICD_FILENAMES")])


def test_it_writes_nothing_into_a_home(tmp_path):
    """As it does otherwise, with leave to tell its makers of its use."""
    home = {"HOME": str(tmp_path), "XDG_CONFIG_HOME": str(tmp_path / "c")}
    home |= {"XDG_DATA_HOME": str(tmp_path / "d"), "XDG_CACHE_HOME": str(tmp_path / "e")}
    verify = [PROGRAM, "rrd", "verify", tmp_path / "none.rrd"]
    subprocess.run(verify, env=quiet() | home, capture_output=True)
    assert list(tmp_path.iterdir()) == []
    otherwise = {name: value for name, value in (quiet() | home).items() if name != "CI"}
    subprocess.run(verify, env=otherwise, capture_output=True)
    assert list(tmp_path.iterdir()), "it is quiet by itself: this test shows nothing"


@pytest.mark.slow
@pytest.mark.skipif(
    not DRIVERS, reason="needs a Vulkan driver, for instance Debian's mesa-vulkan-drivers"
)
def test_the_viewer_shows_the_arm_miss_and_hit(recording, tmp_path):
    before, after = tmp_path / "before.png", tmp_path / "after.png"
    take_pictures(recording, {before: BEFORE, after: ends(recording)[1]})
    orange = []
    for png in (before, after):
        with Image.open(png) as picture:
            pixels = np.asarray(picture.convert("RGB"), int)
        assert pixels.shape[1] == 1400 and png.stat().st_size < 300_000
        red, green, blue = np.moveaxis(pixels[:, 530:], -1, 0)  # of the arm's view
        orange.append(np.sum((red > 180) & (green < 140) & (blue < 100)))
    assert orange[0] > 2000 > 2 * orange[1], "what is hit is hidden"
    take_pictures(recording, {before: BEFORE}, view=ARM, window=(800, 600))
    with Image.open(before) as picture:
        assert picture.width < 520, "one view of a smaller window"
