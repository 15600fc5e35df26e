"""Authors and address of the project: fields of pyproject.toml that a release needs.

`python -m replication.pages.imprint` fails while one of them is missing, or if another file
contradicts them.
"""

import json
import re
import sys
import tomllib
from pathlib import Path
from typing import Any, NamedTuple, Self

import yaml

import recalib

NOBODY = "The recalib authors"  # a placeholder in pyproject.toml until publication


class Imprint(NamedTuple):
    """The authors, and the address of the repository."""

    authors: tuple[str, ...]  # names, in order
    repository: str  # address of the code; empty until publication

    @classmethod
    def read(cls, project: Path = Path()) -> Self:
        """The imprint of the project in a folder."""
        fields = tomllib.loads((project / "pyproject.toml").read_text(encoding="utf-8"))["project"]
        names = tuple(author["name"] for author in fields["authors"])
        return cls(names, fields.get("urls", {}).get("Repository", ""))


def missing(project: Path = Path()) -> list[str]:
    """Missing or contradictory fields, in one sentence each."""
    imprint = Imprint.read(project)
    mistakes = []
    if NOBODY in imprint.authors:
        mistakes.append(f"pyproject.toml: authors are {NOBODY!r}; expected: names of people.")
    if not re.fullmatch(r"https://\S+[^/\s]", imprint.repository):
        mistakes.append(
            f"pyproject.toml: Repository in [project.urls] is {imprint.repository!r}; expected:"
            " the address of the code, such as https://github.com/OWNER/recalib."
        )
    expected = {
        "version": recalib.__version__,
        "authors": [*imprint.authors],
        "repository": imprint.repository,
    }
    for name, found in _elsewhere(project).items():
        mistakes += [
            f"{name}: {field} is {value!r}; expected: {expected[field]!r}."
            for field, value in found.items()
            if value != expected[field]
        ]
    return mistakes


def _elsewhere(project: Path) -> dict[str, dict[str, Any]]:
    """The same fields in the files that archives and catalogues read."""
    citation = yaml.safe_load((project / "CITATION.cff").read_text(encoding="utf-8"))
    zenodo = json.loads((project / ".zenodo.json").read_text(encoding="utf-8"))
    return {
        "CITATION.cff": {
            "version": citation["version"],
            "authors": [_name(author) for author in citation["authors"]],
            "repository": citation.get("repository-code", ""),
        },
        ".zenodo.json": {
            "version": zenodo["version"],
            "authors": [_name(author) for author in zenodo["creators"]],
        },
    }


def _name(author: dict[str, str]) -> str:
    """The name of a person or group, from CITATION.cff or Zenodo's "Family, Given"."""
    if "given-names" in author:
        return f"{author['given-names']} {author['family-names']}"
    return " ".join(reversed(author["name"].split(", ")))


if __name__ == "__main__":
    _mistakes = missing()
    print("\n".join(_mistakes) or "Authors, address and version are the same everywhere.")
    sys.exit(bool(_mistakes))
