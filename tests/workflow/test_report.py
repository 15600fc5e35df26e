"""The report, seen in a real browser."""

import re
from dataclasses import dataclass, field
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pandas as pd
import pytest
from selenium.common.exceptions import WebDriverException
from selenium.webdriver.common.by import By
from selenium.webdriver.support.wait import WebDriverWait

from recalib.study.evidence import report as report_
from tests.browser import chromium, needs_chromium, requests, severe
from tests.conftest import ROOT
from tests.workflow.conftest import TINY, snakemake

PATIENCE = 60  # seconds for what a click brings to appear
PAIR = re.compile(r"(\d+\.\d\d) cm and (\d+\.\d\d) degrees")
# The menu slides open and shut, and a click on what moves may meet its neighbour.
STILL = """document.head.append(Object.assign(document.createElement('style'),
 {textContent: '* {transition: none !important}'}))"""

PHONE = {"width": 390, "height": 844, "deviceScaleFactor": 1, "mobile": True}
LOW = {"width": 1280, "height": 600, "deviceScaleFactor": 1, "mobile": False}
HIDDEN = "return !document.querySelector('#rulegraph')?.getBoundingClientRect().width"
BROKEN = """return [...document.images].filter(image => !image.naturalWidth).length
 + [...document.querySelectorAll("svg:not(#rulegraph svg)")]
   .filter(drawing => !drawing.getBoundingClientRect().width).length"""

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group(name="workflow"), needs_chromium]


@dataclass
class Visit:
    """What a visitor saw who clicked on everything."""

    front: str = ""
    links: list[str] = field(default_factory=list)
    pages: dict[str, str] = field(default_factory=dict)  # text of each, by its label
    drawings: dict[str, int] = field(default_factory=dict)  # how many each has
    table: list[list[str]] = field(default_factory=list)  # cells of the table of errors
    broken: int = 0  # images and drawings
    console: list[str] = field(default_factory=list)
    requests: set[str] = field(default_factory=set)


@pytest.fixture(scope="module")
def report(continued) -> Path:
    style = "--report-stylesheet", "workflow/report/style.css"
    finished = snakemake(continued, "--report", f"{TINY}/report.html", *style)
    assert finished.returncode == 0, finished.stdout
    return continued / TINY / "report.html"


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    with chromium(tmp_path_factory.mktemp("browser")) as driver:
        yield driver


def click(browser, xpath: str) -> None:
    """Click on something as soon as it is there."""
    wait = WebDriverWait(browser, PATIENCE, 0.1, ignored_exceptions=[WebDriverException])
    wait.until(lambda _: browser.find_element(By.XPATH, xpath).click() is None, f"no {xpath}")


def read(browser, label: str, visit: Visit) -> None:
    """Read the page that a click opened, once it is the one with this label."""

    def opened(_) -> bool:
        # again at every look: Chromium may put another frame in place of the last
        browser.switch_to.default_content()
        browser.switch_to.frame(browser.find_element(By.TAG_NAME, "iframe"))
        return browser.find_element(By.TAG_NAME, "h1").text == label

    WebDriverWait(browser, PATIENCE, 0.1, ignored_exceptions=[WebDriverException]).until(
        opened, f"no page {label!r}"
    )
    visit.pages[label] = browser.execute_script("return document.body.textContent")
    visit.drawings[label] = len(browser.find_elements(By.TAG_NAME, "svg"))
    visit.broken += browser.execute_script(BROKEN)
    for row in browser.find_elements(By.CSS_SELECTOR, "#summary tbody tr"):
        visit.table.append([cell.text for cell in row.find_elements(By.TAG_NAME, "td")])
    browser.switch_to.default_content()


@pytest.fixture(scope="module")
def visit(browser, report) -> Visit:
    seen = Visit()
    browser.get(report.as_uri())
    browser.execute_script(STILL)
    click(browser, "//nav//span[.='Workflow']")
    WebDriverWait(browser, PATIENCE).until(
        lambda _: browser.find_elements(By.CSS_SELECTOR, "#rulegraph canvas")
    )
    seen.front = browser.find_element(By.CSS_SELECTOR, ".prose").get_attribute("textContent")
    seen.links = [
        link.get_attribute("href") for link in browser.find_elements(By.CSS_SELECTOR, ".prose a")
    ]
    seen.broken = browser.execute_script(BROKEN)
    click(browser, "//nav//span[.='Statistics']")
    WebDriverWait(browser, PATIENCE).until(
        lambda _: len(browser.find_elements(By.CSS_SELECTOR, "canvas")) == 2
    )
    click(browser, "//nav//span[.='About']")
    click(browser, "//nav//span[starts-with(., 'snakemake ')]")
    for category in browser.execute_script("return Object.keys(categories)"):
        click(browser, "//nav//ol//a")
        click(browser, f"//nav//span[.='{category}']")
        rows = browser.find_elements(By.CSS_SELECTOR, "nav tbody tr")
        for number, label in enumerate([row.text for row in rows], start=1):
            click(browser, f"(//nav//tbody/tr)[{number}]//a[1]")
            read(browser, label, seen)
            click(browser, f"(//nav//tbody/tr)[{number}]//a[2]")
            click(browser, f"//nav//ol//a[.='{category}']")
    seen.console, seen.requests = severe(browser), requests(browser)
    return seen


def test_there_is_no_error_in_the_console_and_no_broken_image(visit):
    assert visit.console == []
    assert visit.broken == 0


def test_nothing_is_asked_of_the_network(visit, report):
    asked = {urlsplit(url) for url in visit.requests}
    assert {url.scheme for url in asked} <= {"file", "data"}
    assert {unquote(url.path) for url in asked if url.scheme == "file"} == {str(report)}


def test_every_figure_is_shown_with_a_caption(visit, continued):
    shown = [label for label in visit.drawings if label.startswith("Figure")]
    assert all(visit.drawings[label] == 1 for label in shown)
    assert sorted(re.findall(r"^Figure \d+", label)[0] for label in shown) == sorted(
        path.stem.replace("figure", "Figure ")
        for path in (continued / TINY / "figures").glob("figure*.svg")
    )
    assert {
        "Errors before and after learning",
        "The damage in every scenario",
    } <= visit.pages.keys()


def test_the_front_leads_to_every_kind_of_page_and_shows_no_graph(visit, browser):
    for words in ("every claim with its criterion", "judged by", "all errors", "cite"):
        assert words in visit.front
    click(browser, "//nav//ol//a")
    click(browser, "//nav//span[.='Workflow']")
    assert browser.execute_script(HIDDEN)


def where(browser, report, screen: dict, *parts: str) -> list[dict]:
    """Where parts of the report lie when it is opened on a screen."""
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", screen)
    browser.get(report.as_uri())
    wait = WebDriverWait(browser, PATIENCE, ignored_exceptions=[WebDriverException])
    places = [
        wait.until(lambda _, its=its: browser.find_element(By.CSS_SELECTOR, its)).rect
        for its in parts
    ]
    browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
    return places


def test_a_front_taller_than_the_window_begins_with_its_heading(browser, report):
    heading, page = where(browser, report, LOW, ".prose h1", ".prose")
    assert page["height"] > LOW["height"]
    assert heading["y"] >= 0


def test_on_a_phone_the_menu_stands_above_the_page(browser, report):
    menu, page = where(browser, report, PHONE, "nav", ".prose")
    assert menu["y"] + menu["height"] <= page["y"]
    assert page["x"] >= 0 and page["x"] + page["width"] <= PHONE["width"]


def test_every_recording_is_linked(visit, report):
    files = {Path(unquote(urlsplit(link).path)) for link in visit.links if link.endswith(".rrd")}
    assert files == set((report.parent / "recordings").glob("*.rrd"))


def test_the_table_of_errors_is_the_summary(visit, report):
    def cell(run, column) -> str:
        low, high = run[f"{column}_low"], run[f"{column}_high"]
        return f"{run[column]:.3f}\n{low:.3f} – {high:.3f}"

    summary = pd.read_csv(report.parent / "summary.csv").to_dict("records")
    columns = [
        f"{moment}_{error}"
        for error in ("position_error_cm", "orientation_error_deg")
        for moment in ("initial", "final")
    ]
    assert [row[2:] for row in visit.table] == [
        [str(run["searches"]), str(run["seeds"]), f"{run['iterations']:,}"]
        + [cell(run, column) for column in columns]
        for run in summary
    ]


def test_every_pair_of_errors_in_a_text_is_one_of_the_summary(visit, report):
    summary = pd.read_csv(report.parent / "summary.csv").set_index(["scenario", "learner"])
    pairs = {
        (
            f"{run[f'{moment}_position_error_cm']:.2f}",
            f"{run[f'{moment}_orientation_error_deg']:.2f}",
        ): (*name, moment)
        for name, run in summary.iterrows()
        for moment in ("initial", "final")
    }
    for label, text in {"front": visit.front, **visit.pages}.items():
        if label == report_.heading("claims", ROOT):
            continue  # they also tell of the typical search alone
        assert set(PAIR.findall(text)) <= pairs.keys(), label
    main = ("links_encoders", "improved", "final")
    said = PAIR.findall(visit.pages[report_.heading("figure1", ROOT)])
    assert main in {pairs[pair] for pair in said}
