"""Recordings and report in a window, or in a real browser that asks nothing of other machines."""

import re
import socket
import threading
from contextlib import contextmanager
from types import SimpleNamespace
from urllib.parse import urlsplit
from urllib.request import urlopen

import numpy as np
import pytest
from PIL import Image
from selenium.webdriver.common.by import By
from selenium.webdriver.support.wait import WebDriverWait

from recalib.damaged.damage import EncoderShift, LinkShortening
from tests.browser import chromium, needs_chromium, requests, severe
from workflow import watch

PATIENCE = 120  # seconds: the viewer draws in software
SOFTWARE = "--use-angle=swiftshader", "--enable-unsafe-swiftshader"  # WebGL without a graphics card
OWN = "links and encoders"  # the recording of the study's own scenario
SHADED = 2000  # colours of the right half where an arm is drawn: text and grids have some hundred


@contextmanager
def served(folder):
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
@pytest.mark.xdist_group(name="workflow")
def test_a_browser_draws_the_arm_and_asks_nothing_of_other_machines(continued, tmp_path):
    picture = str(tmp_path / "page.png")
    arm = continued.results / "figures" / "arm_before.png"
    Image.new("RGB", (4, 3)).save(arm)
    with served(continued.results) as address, chromium(tmp_path / "profile", *SOFTWARE) as browser:
        browser.set_page_load_timeout(PATIENCE)
        browser.get(address)
        assert browser.find_element(By.TAG_NAME, "h1").text == "Study tiny"
        assert browser.find_element(By.CSS_SELECTOR, "main > img").is_displayed()
        arm.unlink()
        empty = colours(browser, picture)
        browser.find_element(By.LINK_TEXT, OWN).click()
        WebDriverWait(browser, PATIENCE, 1).until(
            lambda _: colours(browser, picture) > SHADED, "no arm is drawn"
        )
        assert empty < SHADED
        hosts = {urlsplit(url).netloc for url in requests(browser)}
        assert hosts <= {urlsplit(address).netloc, ""}
        assert severe(browser) == [], "the viewer asked other machines, and was refused"


@pytest.fixture
def one_recorded(tmp_path, monkeypatch):
    """A folder of results with an empty recording; there is no viewer."""
    monkeypatch.setattr(watch, "copy_viewer", lambda folder: folder.mkdir())
    results = tmp_path / "fallen"
    for name in (
        "recordings/on_stone-z1.rrd",
        "figures/on_stone-z1_before.png",
        "report.html",
        "scenarios/on_stone-z1.json",
        "recordings/alone.rrd",
    ):
        (results / name).parent.mkdir(parents=True, exist_ok=True)
        (results / name).touch()
    damages = [LinkShortening("wrist_1_link", 0.01), EncoderShift("wrist_3_joint", np.radians(3))]
    resolved = SimpleNamespace(damages=damages)
    monkeypatch.setattr(
        watch.Resolved, "read", lambda path: {"on_stone-z1.json": resolved}[path.name]
    )
    return results


def test_the_page_says_in_words_what_was_recorded_and_shows_a_picture(one_recorded):
    with served(one_recorded) as address, urlopen(address) as answer:
        page = answer.read().decode()
    for part in (
        ">on and stone on the Z1</a>",
        "<small>wrist 1: 1 cm short; wrist 3: encoder 3 deg</small>",
        '<img src="results/figures/on_stone-z1_before.png"',
        '<a href="results/report.html">The report of this study</a>',
        ">alone</a>",  # whose scenario is not there any more
    ):
        assert part in page


def test_where_nothing_was_recorded_it_says_what_makes_a_recording(tmp_path):
    with pytest.raises(SystemExit, match=r"no recording in .*; `make quick` makes some"):
        watch.main([str(tmp_path)])


def test_it_listens_here_alone_and_says_how_to_get_there(one_recorded, monkeypatch, capsys):
    monkeypatch.setattr(watch.ThreadingHTTPServer, "serve_forever", lambda server: None)
    with socket.socket() as taken:
        taken.bind((watch.HERE, 0))
        port = taken.getsockname()[1]
        taken.listen()
        with pytest.raises(SystemExit, match=f"port {port} is taken; try another one"):
            watch.main([str(one_recorded), "--port", str(port)])
    watch.main([str(one_recorded), "--port", str(port)])
    said = capsys.readouterr().out
    assert f"http://127.0.0.1:{port}/" in said
    assert re.search(rf"ssh -L {port}:127\.0\.0\.1:{port} \S+@\S+", said)
    with watch.site(one_recorded) as server:
        assert server.server_address[0] == "127.0.0.1"
