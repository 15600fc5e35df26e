"""Recordings in a browser that asks nothing of other machines, and in a viewer that is quiet."""

import os
import re
import socket
import subprocess
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from urllib.parse import urlsplit
from urllib.request import urlopen

import numpy as np
import pytest
from PIL import Image
from selenium.webdriver.common.by import By
from selenium.webdriver.support.wait import WebDriverWait

from replication.recording import ARM, BEFORE, ends, take_pictures, watch
from replication.recording.viewer import PROGRAM, quiet
from tests.browser import chromium, needs_chromium, requests, severe

PATIENCE = 120  # seconds: the viewer draws in software
SOFTWARE = "--use-angle=swiftshader", "--enable-unsafe-swiftshader"  # WebGL without a graphics card
SHADED = 2000  # colours of the right half where an arm is drawn: text and grids have some hundred


@contextmanager
def served(folder: Path) -> Iterator[str]:
    """The address of a folder of results in the background."""
    with watch.site(folder) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        yield "http://{}:{}/".format(*server.server_address)
        server.shutdown()
        thread.join()


def colours(browser, picture) -> int:
    """How many colours the right half of the page has."""
    browser.save_screenshot(picture)
    with Image.open(picture) as image:
        half = image.convert("RGB").crop((image.width // 2, 0, *image.size))
        return len(half.getcolors(half.width * half.height))


@pytest.mark.slow
@needs_chromium
def test_a_browser_draws_the_arm_and_asks_nothing_of_other_machines(recording, tmp_path):
    picture = str(tmp_path / "page.png")
    recordings = tmp_path / "results" / "recordings"
    recordings.mkdir(parents=True)
    (recordings / recording.name).symlink_to(recording)
    with (
        served(recordings.parent) as address,
        chromium(tmp_path / "profile", *SOFTWARE) as browser,
    ):
        browser.set_page_load_timeout(PATIENCE)
        browser.get(address)
        assert colours(browser, picture) < SHADED
        browser.find_element(By.LINK_TEXT, "links encoders").click()
        WebDriverWait(browser, PATIENCE, 1).until(
            lambda _: colours(browser, picture) > SHADED, "no arm is drawn"
        )
        hosts = {urlsplit(url).netloc for url in requests(browser)}
        assert hosts <= {urlsplit(address).netloc, ""}
        assert severe(browser) == [], "the viewer asked other machines, and was refused"


@pytest.fixture
def results(tmp_path, monkeypatch) -> Path:
    """A folder of results with an empty recording; there is no viewer."""
    monkeypatch.setattr(watch, "copy_viewer", lambda folder: folder.mkdir())
    (tmp_path / "recordings").mkdir()
    (tmp_path / "recordings" / "on <stone>.rrd").touch()
    return tmp_path


def test_the_page_links_each_recording_and_escapes_its_name(results):
    with served(results) as address:
        page = urlopen(address).read().decode()
        link = re.search(r'<li><a href="([^"]+)">on &lt;stone&gt;</a>', page)
        assert urlopen(address + link[1]).status == 200


def test_where_nothing_was_recorded_it_says_what_makes_a_recording(tmp_path):
    with pytest.raises(SystemExit, match=r"no recording in .*; `make quick` makes some"):
        watch.main([str(tmp_path)])


def test_it_listens_here_alone_and_says_how_to_get_there(results, monkeypatch, capsys):
    monkeypatch.setattr(watch.ThreadingHTTPServer, "serve_forever", lambda server: None)
    with socket.socket() as taken:
        taken.bind((watch.HERE, 0))
        port = taken.getsockname()[1]
        taken.listen()
        with pytest.raises(SystemExit, match=f"port {port} is taken; try another one"):
            watch.main([str(results), "--port", str(port)])
    watch.main([str(results), "--port", str(port)])
    said = capsys.readouterr().out
    assert f"http://127.0.0.1:{port}/" in said
    assert re.search(rf"ssh -L {port}:127\.0\.0\.1:{port} \S+@\S+", said)
    with watch.site(results) as server:
        assert server.server_address[0] == "127.0.0.1"


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
@pytest.mark.skipif(not DRIVERS, reason="needs a Vulkan driver: Debian's mesa-vulkan-drivers")
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
