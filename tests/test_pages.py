"""The pages say what the results say."""

import json
import re
from functools import cache

import pandas as pd
import pytest

from replication.judgement.checks import expect
from replication.pages import words
from replication.pages.readme import in_a_sentence
from replication.pages.rendering import PAGES, render
from tests.conftest import ROOT
from tests.synthetic import Synthetic, few_resamples, unread

RESULTS = ROOT / "results"
README = ROOT / "README.md"
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


@cache
@few_resamples()
def made(page: str, synthetic: Synthetic) -> tuple[dict, set[str]]:
    """What a page may say, and what it declares and does not read."""
    context: dict = {}
    evidence = synthetic.evidence(PAGES[page].NEEDS)
    left = unread(evidence, lambda its: context.update(PAGES[page].context(its)))
    return context, left


def rendered(page: str, synthetic: Synthetic) -> str:
    context, _ = made(page, synthetic)
    return render(ROOT / "workflow" / "templates" / f"{page}.j2", context)


@pytest.mark.parametrize("page", PAGES)
def test_noise_in_the_last_digits_changes_no_letter(page, synthetic, disturbed):
    assert rendered(page, synthetic) == rendered(page, disturbed)
    bands = [
        expect(pd.read_csv(results.path("summary.csv"))).to_csv(float_format="%.4g")
        for results in (synthetic, disturbed)
    ]
    assert bands[0] == bands[1]


@pytest.mark.parametrize("page", PAGES)
def test_a_page_reads_all_that_it_declares(page, synthetic):
    """And nothing else, or it could not be made."""
    assert made(page, synthetic)[1] == set()


def test_no_computing_time_is_printed(synthetic):
    assert not re.search(r"\d m?s\b", rendered("guidance.md", synthetic))


def test_the_page_of_guidance_is_written_for_any_learners(few, tmp_path):
    fewer = {"learners": ("affine", "improved"), "scenarios": ("translation",)}
    less = few.model_copy(update={"benchmark": few.benchmark.model_copy(update=fewer)})
    its = Synthetic(tmp_path, less)
    its.compare()
    page = rendered("guidance.md", its)
    assert "| translation |" in page and "hybrid" not in page


def test_the_table_of_trainings_says_what_the_summary_says(synthetic):
    summary = pd.read_csv(synthetic.path("summary.csv"))
    table = rows(rendered("results.md", synthetic), "All trainings")
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


def test_the_readme_has_each_claim_in_a_line_under_its_verdict(synthetic):
    claims = json.loads(synthetic.path("claims.json").read_text(encoding="utf-8"))
    section = rendered("README.md", synthetic).split("## Does the paper hold?\n")[1]
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


def test_a_verdict_that_holds_of_one_system_alone_names_it():
    its = {"universes": {"status": "measured", "mean": 0.9, "mean_interval": [0.8, 0.95]}}
    claim = its | {"id": "separate-maps", "verdict": "supported"}
    systems = {name: {"verdict": "supported"} for name in ("ours", "theirs")}
    assert in_a_sentence({"separate-maps": claim | {"systems": systems}}) == {
        "separate-maps": "error x 0.9 (0.8 to 0.95)"
    }
    systems["theirs"] = {"verdict": "no effect"}
    assert in_a_sentence({"separate-maps": claim | {"systems": systems}}) == {
        "separate-maps": "ours: error x 0.9 (0.8 to 0.95); theirs: no effect"
    }


@pytest.mark.parametrize(("holds", "more"), [(43, "; holds in 43 of 64"), (64, "")])
def test_a_mean_says_in_how_many_setups_the_claim_holds_unless_it_does_in_all(holds, more):
    its = {"status": "measured", "mean": 0.9, "mean_interval": [0.8, 0.95], "setups": 64}
    claim = {"id": "schedule", "verdict": "supported", "systems": {}, "universes": its}
    said = in_a_sentence({"schedule": claim | {"universes": its | {"holds": holds}}})
    assert said == {"schedule": f"error x 0.9 (0.8 to 0.95){more}"}


def test_readers_are_told_which_number_is_which(synthetic):
    section = (
        rendered("results.md", synthetic).split("### Which number is which\n")[1].split("\n##")[0]
    )
    summary = pd.read_csv(synthetic.path("summary.csv")).set_index(["scenario", "learner"])
    own = summary.loc[(synthetic.study.scenario, "improved")]
    assert f"{own.seeds} repetitions: {own.searches} searches with" in section
    assert words.pair(own, "final") in section, "the mean over all, not of the typical search"


def test_the_readme_is_read_in_a_few_minutes():
    text = README.read_text(encoding="utf-8")
    assert "today" in text.split("\n\n")[1].split(". ")[1], "why it matters comes second"
    assert len(text.split()) <= 1100
    assert len(re.findall(r"^\|", text, re.MULTILINE)) <= 20, "rows of tables"


@needs_results
@pytest.mark.parametrize(
    "page",
    [
        "README.md",
        "docs/study.js",
        *(f"docs/{name}.md" for name in ("index", "results", "findings", "choices", "deviations")),
    ],
)
def test_the_committed_pages_are_those_of_the_results(page):
    made = RESULTS / "pages" / page.split("/")[-1]
    assert (ROOT / page).read_bytes() == made.read_bytes()
