"""The site in a real browser, checked by axe."""

import re
import sys
from importlib.resources import files
from pathlib import Path
from types import SimpleNamespace
from urllib.parse import unquote, urlsplit

import numpy as np
import pytest
import rerun
from PIL import Image
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.wait import WebDriverWait

import recalib
from tests.browser import chromium, needs_chromium, requests, severe
from tests.conftest import ROOT, run

PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md"))]
PATIENCE = 60  # seconds
AXE = """const done = arguments[0];
const rules = {"link-in-text-block": {enabled: true}};
axe.run({runOnly: ["wcag2a", "wcag2aa"], rules}).then(found => done(found.violations.map(
  its => its.id + ": " + its.nodes.map(node => node.html.slice(0, 200)).join("; "))));"""
BROKEN = "return [...document.images].filter(image => !image.naturalWidth).map(image => image.src)"
LINKS = "return [...document.links].map(link => link.href)"
READY = "return performance.getEntriesByType('navigation')[0].domContentLoadedEventStart"
TOO_WIDE = """return [...document.querySelectorAll("#try *")].filter(its =>
  its.getBoundingClientRect().right > innerWidth).map(its => its.outerHTML.slice(0, 80))"""
NO_PAGES = "404.html", "viewer/index.html"  # for servers; for a frame in a page
MAGENTA = 255, 0, 255  # a colour that nothing else has
SOFTWARE = "--use-angle=swiftshader", "--enable-unsafe-swiftshader"  # WebGL without a graphics card
SCHEME = "return document.body.dataset.mdColorScheme"
SCHEMES = {"light": "default", "dark": "slate"}
# text, signatures, commands, sliders
BY_NIGHT = "index.html", "docs/reference/laboratory.html", "docs/library.html", "docs/try.html"

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group(name="site")]


@pytest.fixture(scope="module")
def site(tmp_path_factory) -> Path:
    """The site, built as `make docs` builds it: a broken link would stop it."""
    folder = tmp_path_factory.mktemp("site")
    recording = tmp_path_factory.mktemp("recordings") / "magenta.rrd"
    with rerun.RecordingStream("magenta") as stream:
        stream.save(recording)
        stream.log("magenta", rerun.Image(np.full((9, 16, 3), MAGENTA, np.uint8)))
    command = sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", folder
    environment = {"PATH": "", "NO_MKDOCS_2_WARNING": "1", "RECORDING": str(recording)}
    built = run(*command, env=environment)
    assert built.returncode == 0, built.stderr
    return folder


@pytest.fixture(scope="module")
def visit(site, tmp_path_factory) -> SimpleNamespace:
    """What a visitor met who opened every page by day, and some by night."""
    axe = (files("axe_core_python") / "axe.min.js").read_text(encoding="utf-8")
    met = SimpleNamespace(violations={}, broken=[], links=set())
    with chromium(tmp_path_factory.mktemp("browser")) as browser:
        browser.set_script_timeout(PATIENCE)
        pages = sorted({*site.rglob("*.html")} - {site / page for page in NO_PAGES})
        for scheme, shown in {"light": pages, "dark": [site / page for page in BY_NIGHT]}.items():
            if scheme == "dark":
                browser.find_element(By.CSS_SELECTOR, "label[title='Dark']").click()
            for page in shown:
                browser.get(page.as_uri())
                assert browser.execute_script(SCHEME) == SCHEMES[scheme]
                met.broken += browser.execute_script(BROKEN)
                met.links |= set(browser.execute_script(LINKS))
                browser.execute_script(axe)
                name = f"{page.relative_to(site)}, {scheme}"
                met.violations[name] = browser.execute_async_script(AXE)
        met.found = search(browser, "campaign")
        met.console, met.requests = severe(browser), requests(browser)
    return met


def search(browser, word: str) -> str:
    """What the site finds on the page that is open."""
    browser.execute_script("document.querySelector('.md-search__input').focus()")
    browser.find_element(By.CSS_SELECTOR, ".md-search__input").send_keys(word)
    first = ".md-search-result__item"
    WebDriverWait(browser, PATIENCE).until(
        lambda _: browser.find_elements(By.CSS_SELECTOR, first), f"nothing found for {word}"
    )
    return browser.find_element(By.CSS_SELECTOR, first).get_attribute("textContent")


def test_every_page_of_the_repository_is_on_the_site(site):
    names = {path.relative_to(site).with_suffix("").as_posix() for path in site.rglob("*.html")}
    pages = {path.relative_to(ROOT).with_suffix("").as_posix() for path in PAGES}
    assert (pages - {"docs/index"}) | {"index", "docs/reference"} <= names


def test_every_public_name_is_on_one_page_of_the_reference(site):
    pages = [page.read_text(encoding="utf-8") for page in (site / "docs/reference").glob("*.html")]
    for name in recalib.__all__:
        assert sum(f'id="recalib.{name}"' in page for page in pages) == 1, name


@needs_chromium
def test_every_page_can_be_read_by_everybody(visit):
    assert {page: found for page, found in visit.violations.items() if found} == {}


@needs_chromium
def test_no_picture_is_broken_and_no_link_leads_nowhere(visit):
    assert visit.broken == []
    inside = {urlsplit(link) for link in visit.links if link.startswith("file:")}
    assert inside
    assert [url.path for url in inside if not Path(unquote(url.path)).exists()] == []


@needs_chromium
def test_nothing_is_asked_of_the_network_the_console_is_silent_and_the_search_works(visit):
    assert visit.console == []
    assert {urlsplit(url).scheme for url in visit.requests} <= {"file", "data", "about"}
    assert "campaign" in visit.found.lower()


@needs_chromium
def test_an_arm_learns_in_the_browser_by_keyboard_on_a_narrow_screen(site, tmp_path):
    with chromium(tmp_path / "browser") as browser:
        narrow = {"width": 360, "height": 800, "deviceScaleFactor": 1, "mobile": False}
        browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", narrow)
        browser.get((site / "docs" / "try.html").as_uri())
        assert browser.execute_script(READY) < 3000, "ms until the sliders can be moved"
        assert browser.execute_script(TOO_WIDE) == []
        elbow = browser.find_element(By.ID, "elbow_joint")
        elbow.send_keys(Keys.ARROW_RIGHT)
        assert elbow.get_attribute("ariaValueText") == "0.5°"
        browser.find_element(By.CSS_SELECTOR, "#try .paper").send_keys(Keys.SPACE)
        summary = browser.find_element(By.CSS_SELECTOR, ".before").text
        before = [float(number) for number in re.findall(r"[\d.]+", summary)]
        assert before == pytest.approx([8.3, 4.7, 0], rel=0.05), "section 7"
        browser.find_element(By.CSS_SELECTOR, "#try .learn").send_keys(Keys.ENTER)
        status = WebDriverWait(browser, PATIENCE).until(
            lambda _: re.fullmatch(
                r"After 200 iterations the tool is off by (.+) cm and (.+)° on average\.",
                browser.find_element(By.CSS_SELECTOR, "[role=status]").text,
            )
        )
        ends = zip(map(float, status.groups()), before[:2], strict=True)
        assert all(after < 0.1 * error for after, error in ends)
        assert severe(browser) == []


@needs_chromium
def test_a_recording_is_shown_on_its_page_without_a_server(site, tmp_path):
    with chromium(tmp_path / "browser", *SOFTWARE) as browser:

        def drawn(_) -> bool:
            browser.save_screenshot(str(tmp_path / "page.png"))
            with Image.open(tmp_path / "page.png") as image:
                return MAGENTA in {colour for _, colour in image.convert("RGB").getcolors(2**24)}

        browser.get((site / "docs" / "watch.html").as_uri())
        browser.find_element(By.CSS_SELECTOR, "button.embed").send_keys(Keys.ENTER)
        frame = browser.find_element(By.CSS_SELECTOR, "iframe.embed")
        browser.execute_script("arguments[0].scrollIntoView()", frame)
        WebDriverWait(browser, 2 * PATIENCE, 1).until(drawn, "the recording is not drawn")
        assert severe(browser) == []
        assert {urlsplit(url).scheme for url in requests(browser)} <= {"file", "data", "blob"}
