"""The pages say what the results say."""

import json
import re

import pandas as pd
import pytest

from recalib.study.evidence.pages import context, measured, n, pair, render
from recalib.study.evidence.results import Evidence
from tests.conftest import ROOT

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


def test_numbers_are_written_for_people():
    assert [n(0.284), n(0.0), n(0.00021), n(12.345, 1)] == ["0.28", "0.00", "2.1e-04", "12.3"]
    assert n(3e-11) == "below 1e-6", "rounding differs from machine to machine"
    row = {"final_position_error_cm": 0.283, "final_orientation_error_deg": 0.291}
    assert pair(row, "final") == "0.28 cm, 0.29 degrees"
    claim = {"measured": {"factor": 30.42, "rest": 0.5}, "interval": {"factor": [29.71, None]}}
    assert measured(claim) == "factor: 30.4 (29.7 to more); rest: 0.5"


@needs_results
def test_the_table_of_trainings_says_what_the_summary_says():
    summary = pd.read_csv(RESULTS / "summary.csv")
    table = rows(README.read_text(), "All trainings")
    assert len(table) == len(summary)
    for cells, row in zip(table, summary.to_dict("records"), strict=True):
        assert cells[:2] == [row["scenario"], row["learner"]]
        assert int(cells[2].replace(",", "")) == row["iterations"] and int(cells[4]) == row["seeds"]
        for cell, moment in zip(cells[5:7], ("initial", "final"), strict=True):
            cm, degrees = (float(number) for number in re.findall(r"[\d.e-]+(?= )", cell))
            assert cm == pytest.approx(row[f"{moment}_position_error_cm"], rel=0.06, abs=0.0051)
            assert degrees == pytest.approx(
                row[f"{moment}_orientation_error_deg"], rel=0.06, abs=0.0051
            )


@needs_results
def test_the_table_of_claims_says_what_the_verdicts_say():
    claims = json.loads((RESULTS / "claims.json").read_text())
    table = rows(README.read_text(), "Does the paper hold?")
    assert [(cells[0], cells[2].strip("*")) for cells in table] == [
        (each["statement"], each["verdict"]) for each in claims
    ]
    for cells, claim in zip(table, claims, strict=True):
        assert cells[3] == measured(claim)


@needs_results
@pytest.mark.parametrize("page", ["README.md", "docs/findings.md"])
def test_the_pages_are_what_the_templates_make_of_the_results(config, page):
    folders = {key: str(ROOT / config[key]) for key in ("results", "figures", "tuned")}
    template = ROOT / "workflow" / "templates" / f"{page.split('/')[-1]}.j2"
    assert (ROOT / page).read_text() == render(
        template, context(Evidence(config | folders), pictures=True)
    )
