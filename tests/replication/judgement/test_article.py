"""The article: what it says follows from the results, and a reader finds all of it."""

import json
import re
from collections import Counter
from collections.abc import Iterator

import pytest

from replication.pages.article import typeset
from replication.pages.rendering import render
from tests.conftest import ROOT
from tests.test_pages import made

TEMPLATE = ROOT / "workflow" / "templates" / "article.typ.j2"
NUMBER = r"(?<![\w.])\d+(?:\.\d+)?"
GIVEN = {"1996"}  # the year of the paper is no result
MEASURED = "measured", "interval", "bounds", "published", "criterion", "statement"


@pytest.fixture(scope="module")
def known(synthetic):
    return made("article.typ", synthetic)[0]


@pytest.fixture(scope="module")
def article(known, tmp_path_factory) -> list[str]:
    """The text of each page of the PDF."""
    pypdf = pytest.importorskip("pypdf")
    pytest.importorskip("typst")
    folder = tmp_path_factory.mktemp("article")
    for part in ("figures", "workflow"):  # Typst reads below its root alone, and follows no link
        (folder / part).mkdir()
    for figure in (ROOT / "figures").glob("*.svg"):  # as large, and empty: no text is read there
        (begins,) = re.findall(r"<svg\b[^>]*>", figure.read_text(encoding="utf-8"))
        (folder / "figures" / figure.name).write_text(f"{begins}</svg>", encoding="utf-8")
    references = folder / "workflow" / "article" / "references.bib"
    references.parent.mkdir()
    references.write_bytes((ROOT / "workflow" / "article" / "references.bib").read_bytes())
    source, pdf = folder / "article.typ", folder / "article.pdf"
    source.write_text(render(TEMPLATE, known), encoding="utf-8")
    typeset(source, pdf, folder)
    return [page.extract_text() for page in pypdf.PdfReader(pdf).pages]


def numbers_in(value) -> Iterator[float]:
    """All of them in values of JSON, also those in sentences."""
    match value:
        case str():
            yield from map(float, re.findall(NUMBER, value))
        case list() | dict():
            for item in value.values() if isinstance(value, dict) else value:
                yield from numbers_in(item)
        case int() | float():
            yield value


def abstract(text: str) -> str:
    """Without markup."""
    found = re.search(r"\*Abstract\.\*(.*?)\n\]", text, re.DOTALL)[1]
    return re.sub(r"[\\_]", "", " ".join(found.split()))


def test_it_has_as_many_pages_as_the_journal_asks_for(article):
    assert 8 <= len(article) <= 12


def test_nothing_in_it_is_a_placeholder_or_an_unresolved_reference(article):
    text = " ".join(article)
    assert not re.search(r"TODO|\?\?|\bnan\b|None|undefined|\{\{|\{%", text)


def test_every_claim_is_in_it_by_its_own_verdict(article, known):
    assert all(its["verdict"] == verdict for verdict in known["by"] for its in known["by"][verdict])
    assert sum(map(len, known["by"].values())) == len(known["claims"])
    text = " ".join(" ".join(article).split()).replace("’", "'")
    for claim in known["claims"]:
        first = " ".join(claim["statement"].split()[:4])
        assert first in text, claim["id"]


def test_the_numbers_of_the_abstract_are_those_of_the_claims(article, synthetic, known):
    claims = json.loads(synthetic.path("claims.json").read_text(encoding="utf-8"))
    verdicts = Counter(claim["verdict"] for claim in claims)
    measured = [[claim[key] for key in MEASURED] for claim in claims]
    results = [len(claims), *verdicts.values(), *numbers_in(measured)]
    page = " ".join(article[0].split())
    numbers = re.findall(NUMBER, page[page.index("Abstract.") : page.index("1 Introduction")])
    assert len(numbers) > 12
    for number in {*numbers} - GIVEN:
        digits = len(number.partition(".")[2])
        assert number in {f"{result:.{digits}f}" for result in results}


@pytest.mark.parametrize("claim", ["theta-increments", "separate-maps"])
def test_another_verdict_changes_abstract_text_and_table(known, claim):
    before = render(TEMPLATE, known)
    changed = [
        its | {"verdict": "contradicted"} if its["id"] == claim else its for its in known["claims"]
    ]
    by = {verdict: [its for its in changed if its["verdict"] == verdict] for verdict in known["by"]}
    of = {its["id"]: its for its in changed}
    after = render(TEMPLATE, known | {"claims": changed, "by": by, "of": of})
    statement = of[claim]["statement"].rstrip(".")
    assert statement in abstract(after) and statement not in abstract(before)
    assert after.count("*Contradicted*") == 1 and "*Contradicted*" not in before
    assert len(re.findall(r"^\*[A-Z]", after, re.MULTILINE)) < len(
        re.findall(r"^\*[A-Z]", before, re.MULTILINE)
    ), "a paragraph that was written for another verdict is gone"
