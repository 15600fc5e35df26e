"""Authors and address of the project: fields of pyproject.toml that a release needs.

`python -m replication.pages.imprint` refuses to publish while one of them is empty, or while
another file has something else.
"""

import json
import re
import sys
import tomllib
from pathlib import Path
from typing import Any, NamedTuple, Self

import yaml

import recalib

NOBODY = "The recalib authors"  # in pyproject.toml until somebody publishes


class Imprint(NamedTuple):
    """Who publishes, and where."""

    authors: tuple[str, ...]  # names, in their order
    repository: str  # address of the code; empty until somebody publishes

    @classmethod
    def read(cls, project: Path = Path()) -> Self:
        """That of the project in a folder."""
        fields = tomllib.loads((project / "pyproject.toml").read_text(encoding="utf-8"))["project"]
        names = tuple(author["name"] for author in fields["authors"])
        return cls(names, fields.get("urls", {}).get("Repository", ""))


def missing(project: Path = Path()) -> list[str]:
    """What a release lacks, a sentence each."""
    imprint = Imprint.read(project)
    lacking = []
    if NOBODY in imprint.authors:
        lacking.append(f"pyproject.toml: authors are {NOBODY!r}; expected: names of people.")
    if not re.fullmatch(r"https://\S+[^/\s]", imprint.repository):
        lacking.append(
            f"pyproject.toml: Repository in [project.urls] is {imprint.repository!r}; expected:"
            " the address of the code, such as https://github.com/OWNER/recalib."
        )
    expected = {
        "version": recalib.__version__,
        "authors": [*imprint.authors],
        "repository": imprint.repository,
    }
    for name, found in _elsewhere(project).items():
        lacking += [
            f"{name}: {field} is {value!r}; expected: {expected[field]!r}."
            for field, value in found.items()
            if value != expected[field]
        ]
    return lacking


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
    """Of a person or a group, in the words of CITATION.cff or of Zenodo: "Family, Given"."""
    if "given-names" in author:
        return f"{author['given-names']} {author['family-names']}"
    return " ".join(reversed(author["name"].split(", ")))


if __name__ == "__main__":
    _lacking = missing()
    print("\n".join(_lacking) or "Authors, address and version are the same everywhere.")
    sys.exit(bool(_lacking))
