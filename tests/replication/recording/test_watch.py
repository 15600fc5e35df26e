"""Recordings in a real browser that asks nothing of other machines."""

import re
import socket
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from urllib.parse import urlsplit
from urllib.request import urlopen

import pytest
from PIL import Image
from selenium.webdriver.common.by import By
from selenium.webdriver.support.wait import WebDriverWait

from replication.recording import watch
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
