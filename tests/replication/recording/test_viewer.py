"""The viewer leaves nothing in a home, is started in one way alone, and takes pictures."""

import os
import subprocess
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from PIL import Image

from recalib.errors import RecalibError
from recalib.laboratory.viewer.process import PROGRAM, quiet
from replication.recording import pictures
from replication.recording.phases import ARM, BEFORE
from replication.recording.pictures import ends, take_pictures
from tests.conftest import ROOT

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


def test_nothing_else_starts_it():
    own, viewer = Path(__file__), ROOT / "recalib" / "laboratory" / "viewer" / "process.py"
    files = [
        path for part in ("recalib", "replication", "tests") for path in (ROOT / part).rglob("*.py")
    ]
    starting = {path for path in files if "rerun_cli" in path.read_text(encoding="utf-8")}
    assert starting - {own} == {viewer}


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


@pytest.mark.skipif(bool(DRIVERS), reason="shows what one without a Vulkan driver is told")
def test_without_a_driver_one_is_told_of_it(recording, tmp_path):
    with pytest.raises(RecalibError, match="needs a Vulkan driver"):
        take_pictures(recording, {tmp_path / "before.png": BEFORE})
    assert not list(tmp_path.iterdir())


def test_a_recording_that_is_still_loading_is_waited_for(tmp_path):
    loading = SimpleNamespace(loading=True, recordings=[])
    states = iter([loading, loading, SimpleNamespace(loading=False, recordings=["arm"])])
    client = SimpleNamespace(open=lambda _: None, get_state=lambda: next(states))
    pictures._load(client, tmp_path / "arm.rrd")
    assert next(states, None) is None


def test_a_viewer_that_is_busy_is_asked_again():
    answers = iter([RuntimeError("Deadline expired before operation could complete"), "shown"])

    def show(frame, play_state):
        assert (frame, play_state) == (7, "paused")
        match next(answers):
            case RuntimeError() as busy:
                raise busy
            case shown:
                return shown

    process = SimpleNamespace(poll=lambda: None)
    client = pictures._Patient(process, SimpleNamespace(set_time=show))
    assert client.set_time(7, play_state="paused") == "shown"
