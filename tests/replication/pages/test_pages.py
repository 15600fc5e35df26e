"""Pages and article say what the findings say, also while the campaign is not complete."""

import re
import shutil
from pathlib import Path

import pandas as pd
import pytest
import yaml

from replication.config import read_study
from replication.pages import OUTCOME, Contents, pages_of, render, write
from replication.plots import Figure
from replication.training import BOTH
from tests.conftest import ROOT

FIGURES = [Path(f"{figure.file}.svg") for figure in Figure]
ALL, SOME = 30, 22


@pytest.fixture(scope="session")
def complete(study, project) -> Contents:
    return Contents(study, FIGURES, project(study, ALL))


@pytest.fixture(scope="session")
def partial(study, project) -> Contents:
    return Contents(study, FIGURES, project(study, SOME))


def rows(page: str, head: str) -> list[list[str]]:
    """Cells of the table below a head."""
    lines = page.split(f"\n{head}\n", 1)[1].splitlines()[1:]
    table = lines[: next(i for i, line in enumerate(lines) if not line.startswith("|"))]
    return [[cell.strip() for cell in line.strip("|").split(" | ")] for line in table]


def test_the_readme_has_eight_claims_with_number_and_verdict(complete, capsys):
    table = rows(render("README.md", complete), "| The paper says | We find | Verdict |")
    by_claim = {claim.statement.claim: claim for claim in complete.claims.values()}
    assert len(table) == 8
    for says, found, verdict in table:
        assert verdict == by_claim[says].finding.verdict
        assert by_claim[says].value in found
    (code,) = re.findall(r"```python\n(.*?)```", render("README.md", complete), re.DOTALL)
    assert len(code.splitlines()) <= 12
    exec(code, {})
    before, after = (float(line.split()[0]) for line in capsys.readouterr().out.splitlines())
    assert before > 10 and after < 0.3  # mm; the noise is 0.1


HEAD = "| claim | section | result (95 % interval) | verdict |"


def test_each_claim_has_a_row_and_its_reasons(complete):
    page = render("findings.md", complete)
    found = complete.evidence.findings()
    table = rows(page, HEAD)
    assert [cells[3] for cells in table] == [
        found[name].verdict if name in found else "not measured" for name in complete.claims
    ]
    anchors = {
        re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-")
        for heading in re.findall(r"^### (.+)$", page, re.MULTILINE)
    }
    assert {re.search(r"\(#(.+)\)", cells[0])[1] for cells in table} == anchors
    _, *reasons = re.split(r"^> .*$", render("findings.md", complete), flags=re.MULTILINE)
    reasons = [text.partition("\n### ")[0] for text in reasons]
    assert len(reasons) == len(complete.claims)
    assert max(len(text.split()) for text in reasons) <= 120


def test_shares_of_an_error_are_in_percent_and_ratios_are_not(complete):
    share, ratio = complete.claims["figure-1"], complete.claims["separate-maps"]
    assert re.fullmatch(r"[\d.]+ % \([\d.]+ to [\d.]+ %\)", share.value)
    assert re.fullmatch(r"[\d.]+ \([\d.]+ to [\d.]+\)", ratio.value)
    slow = complete.claims["ritter-slow"]
    start = slow.finding.estimates[1]  # with a random start, over the identity
    assert "%" in slow.value and "%" not in slow.text(start)


def test_setups_are_counted_beside_their_fitted_shares(complete):
    claim = complete.claims["theta-increments"]
    counts = complete.counts(claim)
    assert list(counts) == list(claim.finding.spread.shares)
    assert counts == {"supported": ALL, "no effect": 0, "contradicted": 0}


def test_one_more_length_makes_the_factor_more_exact(complete):
    registered, more = complete.claims["speed-up"].number, complete.halfway
    assert more.value == pytest.approx(70, rel=0.05)  # the synthetic map needs 14,000 iterations
    assert more.value < registered.value


def test_an_incomplete_campaign_says_how_many_setups_were_measured(partial):
    assert f"**{SOME} of {ALL} registered setups" in render("findings.md", partial)
    assert "Missing: `mapping/solutions.parquet`." in render("findings.md", partial)
    assert f"{SOME} of {ALL} registered setups" in render("README.md", partial)


@pytest.mark.parametrize("contents", ["complete", "partial"])
def test_the_readme_is_read_in_three_minutes_and_what_a_run_prints_fits_a_terminal(
    contents, request
):
    contents = request.getfixturevalue(contents)
    page = render("README.md", contents)
    assert len(page.split()) <= 700
    assert "\n\n\n" not in page
    text = render(OUTCOME, contents)
    assert len(text.splitlines()) <= 20
    assert "8.4 cm, 4.7 degrees" in text and "0.32 cm, 0.23 degrees" in text
    for verdict, claims in contents.verdicts.items():
        assert f"\n- {verdict}, {len(claims)}" in text


def test_a_study_of_ones_own_has_a_page_of_its_claims_without_the_campaign(project, tmp_path):
    own = read_study(ROOT / "config.yaml", {"name": "mine", "experiments": {"evidence": False}})
    assert pages_of(own) == [OUTCOME, "findings.md"]
    write(own, [tmp_path / page for page in pages_of(own)], FIGURES[:1], project(own, 0))
    page = (tmp_path / "findings.md").read_text(encoding="utf-8")
    assert "belongs to the shipped study" in page and "../figures/figure1.png" in page
    assert "| improved | 200 | 8.4 cm, 4.7 degrees | 0.32 cm, 0.23 degrees |" in page
    assert [cells[3] for cells in rows(page, HEAD)] == ["contradicted", "undecided"]
    assert "results/studies/mine/pages/findings.md" in (tmp_path / OUTCOME).read_text()


def test_choices_are_those_of_the_configuration_with_their_reasons(complete):
    page = render("choices.md", complete)
    factors = yaml.safe_load((ROOT / "config.yaml").read_text())["campaign"]["factors"]
    head = "| open in the paper | chosen | alternatives | what the paper says, and the readings |"
    table = rows(page, head)
    assert [cells[1] for cells in table] == [
        str(levels[0]).replace("_", " ") for levels in factors.values()
    ]
    assert all(len(cells[3].split()) > 5 for cells in table)
    assert all(all(cells) for cells in rows(page, "| key | value | reason |"))


def test_a_template_of_typst_gets_results_without_markup(study, project, monkeypatch):
    folder = project(study, 0)
    (folder / "workflow" / "templates" / "it.typ.j2").write_text(
        "{% macro bold(it) %}*{{ it }}*{% endmacro %}{{ bold(results.text) }} _d_"
    )
    contents = Contents(study, (), folder)
    monkeypatch.setattr(contents, "text", "a_b #c", raising=False)
    assert render("it.typ", contents) == r"*a\_b \#c* _d_"


@pytest.fixture
def contents(study, project) -> Contents:
    """One scenario, in which the hybrid is 20 % worse than geometry after 8 moves."""
    folder, own = project(study, 0), {"scenario": "links_encoders"}
    errors = pd.DataFrame(
        [  # of position [cm] after 4 and 8 moves
            ("geometric", 4, 0.10), ("geometric", 8, 0.05), ("hybrid", 4, 0.10),
            ("hybrid", 8, 0.06), ("improved", 4, 4.0), ("improved", 8, 0.01),
        ],
        columns=["learner", "moves", "position_error_cm"],
    ).assign(**own, seeds=20, orientation_error_deg=0.1)  # fmt: skip
    errors.to_csv(folder / "results" / "benchmark.csv", index=False)
    endless = float("inf")
    reached = pd.DataFrame(
        [("geometric", 3, 2, 6), ("hybrid", 3, 3, 3), ("improved", endless, endless, endless)],
        columns=["learner", "moves", "low", "high"],
    ).assign(**own, error=BOTH, threshold=min(study.benchmark.thresholds))
    reached.to_csv(folder / "results" / "benchmark_moves.csv", index=False)
    real = pd.DataFrame({"learner": ["geometric", "improved", "improved"], "poses": [10, 10, 400]})
    real = real.assign(twin=[False, True, True], position_error_mm=[0.1624, 1.286, 0.2])
    real.to_csv(folder / "results" / "real.csv", index=False)
    return Contents(study, (), folder)


def test_guidance_has_quantiles_of_moves_and_compares_the_hybrid_with_other_learners(contents):
    page = render("guidance.md", contents)
    assert "| scenario | geometric | hybrid | improved |" in page
    assert "| links encoders | 3 (2 to 6) | 3 | - |" in page
    assert "in 1 comparisons, at most by a\nfactor of 1.2: in the scenario links" in page
    (row,) = contents.benchmark.worse
    assert row.moves == 8
    assert row.ratio == pytest.approx(1.2), "over geometry; improved is of 1996"


def test_a_learner_on_the_twin_has_a_row_of_its_own_and_its_last_error(contents):
    page = render("real_arm.md", contents)
    assert "| geometric | - | 0.162 | - |" in page
    assert "| improved on a twin | - | 1.286 | - |" in page
    assert "At the end of its 400 moves, *improved* has an error of 0.200 mm." in page


@pytest.fixture(scope="module")
def article(study, project, tmp_path_factory) -> tuple[str, Contents]:
    """The text of the PDF, with empty figures."""
    pypdf = pytest.importorskip("pypdf")
    pytest.importorskip("typst")
    from replication.pages import typeset

    folder = project(study, 30)
    (folder / "figures").mkdir()
    figures = [folder / "figures" / f"{figure.file}.svg" for figure in Figure]
    for path in (*figures, folder / "figures" / "method.svg"):
        path.write_text('<svg xmlns="http://www.w3.org/2000/svg" width="400" height="200"></svg>')
    shutil.copytree(ROOT / "workflow" / "article", folder / "workflow" / "article")
    write(study, [folder / "article.typ"], figures, folder)
    typeset(folder / "article.typ", folder / "article.pdf", folder)
    pages = pypdf.PdfReader(folder / "article.pdf").pages
    text = " ".join(" ".join(page.extract_text() for page in pages).split())
    return text.replace("’", "'"), Contents(study, figures, folder)


def test_its_table_has_every_claim_its_abstract_the_verdicts_and_nothing_is_a_placeholder(article):
    assert not re.search(r"TODO|\?\?|\bnan\b|None|undefined|\{\{|\{%", article[0])
    text, contents = article
    for claim in contents.claims.values():
        assert " ".join(claim.statement.claim.split()[:4]) in text
    abstract = text[text.index("Abstract.") : text.index("1 Introduction")]
    for verdict, claims in contents.verdicts.items():
        assert f"{len(claims)} {verdict}" in abstract
    assert contents.claims["speed-up"].value in abstract
