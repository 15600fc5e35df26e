"""The texts of the report's pages, without a browser: test_report.py looks at them in one."""

import re
from contextlib import chdir

import pytest

from replication.pages import report
from replication.pages.words import one
from replication.plots.registry import FIGURES, drawn
from tests.conftest import ROOT
from tests.synthetic import unread


@pytest.fixture(scope="module")
def known(synthetic) -> dict:
    with chdir(ROOT):
        return report.context(synthetic.evidence(report.NEEDS))


@pytest.fixture
def figures(few, synthetic, tmp_path) -> dict[str, str]:
    """Drawings of which only the beginning matters."""
    names = drawn(few, synthetic.request)
    for name in names:
        (tmp_path / f"{name}.svg").write_text(f"<?xml ?>\n<svg id='{name}'></svg>")
    return {name: str(tmp_path / f"{name}.svg") for name in names}


def test_every_page_shows_its_figure_and_its_claims(known, figures):
    for name in figures:
        text = report.page(name, known, figures)
        assert f"<svg id='{name}'>" in text and "<?xml" not in text
        claims = report.shown_by(name, known["claims"])
        assert all(f"<b>{claim['id']}</b>" in text for claim in claims)
        assert bool(claims) == ("What it says of the paper" in text)
    assert {claim["id"] for name in figures for claim in report.shown_by(name, known["claims"])}


def test_tables_hold_what_the_results_say(known, figures, synthetic):
    errors = report.page("errors", known, figures)
    assert errors.count("<tr>") == 1 + len(synthetic.trainings.runs)
    settings = report.page("settings", known, figures)
    assert "1 rounds of 100 trials" in settings
    assert settings.count("<tr>") == 1 + len({learner for _, learner in synthetic.trainings.runs})
    damages = report.page("damages", known, figures)
    assert "5 cm, -5 cm, 4.3 cm" in damages
    assert "matplotlib" in report.page("versions", known, figures)
    claims = report.page("claims", known, figures)
    shown = [one(claim, label) for claim in known["claims"] for label in claim["measured"]]
    assert all(f"{number}</span>" in claims for number in shown)
    supported = [each["verdict"] for each in known["claims"]].count("supported")
    assert f"{supported} supported" in claims.replace("\n", " ")


def test_learners_have_the_names_of_the_pages(known, figures):
    settings = report.page("settings", known, figures)
    assert "<td>Ritter&#39;s map, cells of both maps</td>" in settings
    assert "<td>Improved system without increments of theta</td>" in settings
    assert (
        "<td>Coarse grid</td>"
        in report.layout().from_string("<td>{{ learner('coarse_grid_200') }}</td>").render()
    )
    assert "_" not in "".join(re.findall(r"<td>(.*?)</td>", settings))


def test_the_front_leaves_to_snakemake_what_only_it_knows(known, figures):
    text = report.front(known, figures)
    assert f":file: {figures['figure1']}\n\n" in text
    assert "{% for page in parts.values()" in text and "recordings/links_encoders.rrd" in text
    assert ":file:" not in report.front(known, {})


def test_a_page_of_docs_is_drawn_into_the_report_and_its_links_lead_nowhere_else(figures, tmp_path):
    text = "# It\n\n![One](../figures/figure1.png) ![Two](../figures/no.png)\n\n| a |\n| - |\n| 1 |"
    html = report.from_markdown(f"{text}\n\n[there](choices.md), [far](https://x.org)", figures)
    assert "<h1>It</h1>" in html and "<svg id='figure1'>" in html and "<td>1</td>" in html
    assert "<img" not in html and "<p>Two</p>" in html
    assert "choices.md" not in html and '<a href="https://x.org">far</a>' in html
    assert "<?xml" not in html


def test_a_report_reads_all_files_that_it_declares(synthetic):
    """And no others, or it could not be made."""
    evidence = synthetic.evidence(report.NEEDS)
    assert not unread(evidence, report.context) & {*evidence.files}


def test_every_fact_of_the_report_is_said_by_a_page(synthetic):
    texts = "".join(path.read_text() for path in (ROOT / report.TEXTS).glob("*.*"))
    facts = synthetic.evidence(report.NEEDS).facts
    assert [fact for fact in facts if fact not in texts] == []


def test_headings_say_what_is_shown_and_not_what_was_found():
    headings = [
        report.heading(name, ROOT)
        for name, figure in FIGURES.items()
        if figure.part in ("trainings", "evidence")
    ]
    assert all(heading.startswith("Figure ") for heading in headings)
