"""The article is typeset, and its table has every claim."""

import re
import shutil

import pytest

from replication.pages import Contents, write
from replication.plots import Figure
from tests.conftest import ROOT

EMPTY = '<svg xmlns="http://www.w3.org/2000/svg" width="400" height="200"></svg>'


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
        path.write_text(EMPTY)
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
