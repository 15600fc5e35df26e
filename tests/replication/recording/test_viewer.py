"""The viewer leaves nothing in a home, and films."""

import os
import subprocess
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from scipy.ndimage import binary_dilation

from replication.recording import take_film
from replication.recording.film import LAST
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
def test_the_film_shows_the_arm_miss_and_hit(recording, tmp_path):
    take_film(recording, tmp_path / "arm.webp")
    assert (tmp_path / "arm.webp").stat().st_size < 4_000_000
    outlined = []
    with Image.open(tmp_path / "arm.webp") as film:
        for number in range(film.n_frames):
            film.seek(number)
            red, green, blue = np.moveaxis(np.asarray(film.convert("RGB"), int), -1, 0)
            if film.info["duration"] >= LAST:  # before learning, and twice after it
                tool = (red > 150) & (green < 110) & (blue < 80)
                white = np.minimum(np.minimum(red, green), blue) > 240
                outlined.append(binary_dilation(white, iterations=5)[tool].mean())
    before, *after = outlined
    assert len(after) == 2 and min(after) > 0.4 > 1.5 * before
