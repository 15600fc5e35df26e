"""The project's address is one field: what needs it appears when it is there."""

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from replication.pages import Contents, render
from replication.pages.imprint import Imprint, missing
from tests.conftest import ROOT

ADDRESS = "https://example.org/somebody/recalib"
FIELDS = {  # what somebody who publishes fills in
    "pyproject.toml": {
        'authors = [{name = "The recalib authors"}]': (
            'authors = [{name = "Ada Example"}, {name = "Grace Sample"}]'
        ),
        '# Repository = "https://github.com/OWNER/recalib"': f'Repository = "{ADDRESS}"',
    },
    "CITATION.cff": {
        "  - name: The recalib authors\n": (
            "  - {given-names: Ada, family-names: Example}\n"
            "  - {given-names: Grace, family-names: Sample}\n"
        ),
        "license: MIT": f"license: MIT\nrepository-code: {ADDRESS}",
    },
    ".zenodo.json": {
        '{"name": "The recalib authors"}': '{"name": "Example, Ada"}, {"name": "Sample, Grace"}'
    },
}


def fill(folder: Path, leave_out: tuple[str, str] | None = None) -> Path:
    """Fill in all fields of the project in a folder but one."""
    for name, fields in FIELDS.items():
        text = (ROOT / name).read_text(encoding="utf-8")
        for empty, filled in fields.items():
            assert text.count(empty) == 1, f"{name}: {empty}"
            if (name, empty) != leave_out:
                text = text.replace(empty, filled)
        (folder / name).write_text(text, encoding="utf-8")
    return folder


def test_who_fills_in_all_fields_can_publish_unless_a_version_differs(tmp_path):
    project = fill(tmp_path)
    assert Imprint.read(project) == Imprint(("Ada Example", "Grace Sample"), ADDRESS)
    assert missing(project) == []
    text = fill(tmp_path).joinpath("CITATION.cff").read_text(encoding="utf-8")
    (tmp_path / "CITATION.cff").write_text(text.replace("version: 2.0.0", "version: 1.9.9"))
    (refused,) = missing(tmp_path)
    assert "CITATION.cff: version is '1.9.9'" in refused


@pytest.mark.parametrize(
    ("name", "field"), [(name, field) for name, fields in FIELDS.items() for field in fields]
)
def test_an_empty_field_is_refused_by_its_file(tmp_path, name, field):
    assert any(text.startswith(f"{name}: ") for text in missing(fill(tmp_path, (name, field))))


def test_readme_and_article_show_the_address_once_there_is_one(
    study, project: Callable[..., Path], tmp_path
):
    folder = project(study, 0)
    before = Contents(study, (), folder)
    assert "badge.svg" not in render("README.md", before)
    shutil.copy(fill(tmp_path) / "pyproject.toml", folder)
    after = Contents(study, (), folder)
    page = render("README.md", after)
    assert f"{ADDRESS}/actions/workflows/ci.yml/badge.svg" in page
    assert f"git clone {ADDRESS}" in page and len(page.split()) <= 700
    article = render("article.typ", after)
    assert f'#link("{ADDRESS}")' in article and '"Ada Example", "Grace Sample"' in article
