"""The pages say what the results say."""

import json
import re

import pandas as pd
import pytest

from recalib.study.evidence.checks import expect
from recalib.study.evidence.pages import PAGES, render
from recalib.study.evidence.readme import in_a_sentence
from recalib.study.evidence.results import Undeclared
from recalib.study.evidence.words import amounts, headline, n, pair, verdicts
from tests.conftest import ROOT
from tests.made_up import MadeUp, without_one

RESULTS = ROOT / "results"
README = ROOT / "README.md"
ALL_RESULTS = ROOT / "docs" / "results.md"
needs_results = pytest.mark.skipif(
    not (RESULTS / "claims.json").exists(),
    reason="needs the results of a full run, which `make` leaves",
)


def rows(page: str, heading: str) -> list[list[str]]:
    """Cells of the first table below a heading, without its own head."""
    lines = page.split(f"## {heading}\n", 1)[1].splitlines()
    start = next(index for index, line in enumerate(lines) if line.startswith("| ---")) + 1
    table = lines[
        start : next((i for i in range(start, len(lines)) if not lines[i].startswith("|")), None)
    ]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in table]


def test_numbers_are_written_for_people():
    assert [n(0.284), n(0.0), n(0.00021), n(12.345, 1)] == ["0.28", "0.00", "2.1e-04", "12.3"]
    assert n(3e-11) == "below 1e-6", "rounding differs from machine to machine"
    row = {"final_position_error_cm": 0.283, "final_orientation_error_deg": 0.291}
    assert pair(row, "final") == "0.28 cm, 0.29 degrees"
    assert amounts({"link": "forearm_link", "shorten": "4 cm"}) == "forearm_link 4 cm"
    assert amounts({"translate": ["5 cm", "0 cm", "1 cm"]}) == "5 cm, 0 cm, 1 cm"


def rendered(page: str, made_up: MadeUp) -> str:
    context = PAGES[page].context(made_up.evidence(PAGES[page].needs))
    return render(ROOT / "workflow" / "templates" / f"{page}.j2", context)


@pytest.mark.parametrize("page", PAGES)
def test_noise_in_the_last_digits_changes_no_letter(page, made_up, disturbed):
    assert rendered(page, made_up) == rendered(page, disturbed)
    bands = [
        expect(pd.read_csv(each.path("summary.csv"))).to_csv(float_format="%.4g")
        for each in (made_up, disturbed)
    ]
    assert bands[0] == bands[1]


@pytest.mark.parametrize("page", PAGES)
def test_a_page_reads_what_it_declares_and_nothing_else(page, made_up):
    for _, less in without_one(made_up.evidence(PAGES[page].needs)):
        with pytest.raises(Undeclared):
            PAGES[page].context(less)


def test_no_computing_time_is_printed(made_up):
    assert not re.search(r"\d m?s\b", rendered("guidance.md", made_up))


def test_the_page_of_guidance_is_written_for_any_learners(few, tmp_path):
    fewer = {"learners": ("affine", "improved"), "scenarios": ("translation",)}
    less = few.model_copy(update={"benchmark": few.benchmark.model_copy(update=fewer)})
    its = MadeUp(tmp_path, less)
    its.conclude()
    page = rendered("guidance.md", its)
    assert "| translation |" in page and "hybrid" not in page


@needs_results
def test_the_table_of_trainings_says_what_the_summary_says():
    summary = pd.read_csv(RESULTS / "summary.csv")
    table = rows(ALL_RESULTS.read_text(encoding="utf-8"), "All trainings")
    assert len(table) == len(summary)
    for cells, row in zip(table, summary.to_dict("records"), strict=True):
        assert cells[:2] == [row["scenario"], row["learner"]]
        assert int(cells[2].replace(",", "")) == row["iterations"]
        assert [int(cell) for cell in cells[4:6]] == [row["searches"], row["seeds"]]
        for cell, moment in zip(cells[6:8], ("initial", "final"), strict=True):
            cm, degrees = (float(number) for number in re.findall(r"[\d.e-]+(?= )", cell))
            assert cm == pytest.approx(row[f"{moment}_position_error_cm"], rel=0.06, abs=0.0051)
            assert degrees == pytest.approx(
                row[f"{moment}_orientation_error_deg"], rel=0.06, abs=0.0051
            )


@needs_results
def test_the_table_of_claims_says_what_the_verdicts_say():
    claims = json.loads((RESULTS / "claims.json").read_text(encoding="utf-8"))
    table = rows(ALL_RESULTS.read_text(encoding="utf-8"), "Claims")
    assert [(cells[0], *cells[2:4]) for cells in table] == [
        (each["statement"], verdicts(each), headline(each)) for each in claims
    ]


@needs_results
def test_the_readme_has_each_claim_in_a_line_under_its_verdict():
    claims = json.loads((RESULTS / "claims.json").read_text(encoding="utf-8"))
    section = README.read_text(encoding="utf-8").split("## Does the paper hold?\n")[1]
    found, verdict = {}, None
    for line in section.split("\n## ")[0].splitlines():
        if heading := re.fullmatch(r"\*\*(.+)\*\*", line):
            verdict = heading[1].lower()
        elif line.startswith("- "):
            found[line.removeprefix("- ")] = verdict
    judged = {claim["id"]: claim for claim in claims}
    sentences = in_a_sentence(judged)
    assert found == {
        f"{its['statement']} *{sentences[name]}*": its["verdict"] for name, its in judged.items()
    }


def test_the_readme_is_read_in_a_few_minutes():
    text = README.read_text(encoding="utf-8")
    assert len(text.split()) <= 1100
    assert len(re.findall(r"^\|", text, re.MULTILINE)) <= 20, "rows of tables"


@needs_results
@pytest.mark.parametrize(
    "page",
    [
        "README.md",
        *(f"docs/{name}.md" for name in ("results", "findings", "choices", "deviations")),
    ],
)
def test_the_committed_pages_are_those_of_the_results(page):
    made = RESULTS / "pages" / page.split("/")[-1]
    assert (ROOT / page).read_bytes() == made.read_bytes()
