"""The report, seen in a real browser."""

import re
from pathlib import Path
from types import SimpleNamespace
from urllib.parse import unquote, urlsplit

import pandas as pd
import pytest
from selenium.common.exceptions import WebDriverException
from selenium.webdriver.common.by import By
from selenium.webdriver.support.wait import WebDriverWait

from tests.browser import chromium, needs_chromium, requests, severe

PATIENCE = 60  # seconds for what a click brings to appear
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


@pytest.fixture(scope="module")
def report(continued) -> Path:
    path = continued.results / "report.html"
    continued.run("--report", str(path), "--report-stylesheet", "workflow/report/style.css").well()
    return path


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    with chromium(tmp_path_factory.mktemp("browser")) as driver:
        yield driver


def click(browser, xpath: str) -> None:
    """Click on something as soon as it is there."""
    wait = WebDriverWait(browser, PATIENCE, 0.1, ignored_exceptions=[WebDriverException])
    wait.until(lambda _: browser.find_element(By.XPATH, xpath).click() is None, f"no {xpath}")


def read(browser, label: str, visit: SimpleNamespace) -> None:
    """Read the page that a click opened, once it is the one with this label."""

    def opened(_) -> bool:
        # again at every look: Chromium may put another frame in place of the last
        browser.switch_to.default_content()
        browser.switch_to.frame(browser.find_element(By.TAG_NAME, "iframe"))
        return browser.find_element(By.TAG_NAME, "h1").text == label

    WebDriverWait(browser, PATIENCE, 0.1, ignored_exceptions=[WebDriverException]).until(
        opened, f"no page {label!r}"
    )
    visit.drawings[label] = len(browser.find_elements(By.TAG_NAME, "svg"))
    visit.broken += browser.execute_script(BROKEN)
    for row in browser.find_elements(By.CSS_SELECTOR, "#summary tbody tr"):
        visit.table.append([cell.text for cell in row.find_elements(By.TAG_NAME, "td")])
    browser.switch_to.default_content()


@pytest.fixture(scope="module")
def visit(browser, report) -> SimpleNamespace:
    """What a visitor saw who clicked on everything."""
    seen = SimpleNamespace(drawings={}, table=[])
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
        for path in (continued.results / "figures").glob("figure*.svg")
    )
    assert {
        "Errors before and after learning",
        "The damage in every scenario",
    } <= visit.drawings.keys()


def test_the_front_leads_to_every_kind_of_page_and_shows_no_graph(visit, browser):
    for words in ("every claim with its criterion", "claims that it judges", "all errors", "cite"):
        assert words in visit.front
    click(browser, "//nav//ol//a")
    click(browser, "//nav//span[.='Workflow']")
    assert browser.execute_script(HIDDEN)


def test_each_title_on_the_front_opens_its_page(visit, browser, report):
    browser.get(report.as_uri())
    browser.execute_script(STILL)
    click(browser, "//nav//span[.='Workflow']")
    titles = [link.text for link in browser.find_elements(By.CSS_SELECTOR, ".prose li a")]
    assert sorted(titles) == sorted(visit.drawings)
    for title in titles:
        click(browser, f'//a[normalize-space()="{title}"]')
        read(browser, title, SimpleNamespace(drawings={}, broken=0, table=[]))
        click(browser, "//nav//span[.='Workflow']")  # as the front says


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
