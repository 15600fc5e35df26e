"""How large the environment is, and why: `make size`."""

import os
import tomllib
from collections.abc import Iterable
from importlib.metadata import Distribution, distributions
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name
from tabulate import tabulate

PROJECT = Path(__file__).parents[1] / "pyproject.toml"
LARGEST = 4  # of a part that are named


def parts(project: dict, found: dict[str, Distribution]) -> dict[str, list[str]]:
    """What is there for the library, and beyond that for each extra in turn.

    Args:
        project: that part of pyproject.toml.
        found: the distributions that are there, by name.
    """
    asked = {"the library": project["dependencies"], **project["optional-dependencies"]}
    counted: set[str] = set()
    by_part = {}
    for part, requirements in asked.items():
        needed = _needed(requirements, found) - counted
        counted |= needed
        by_part[part] = sorted(needed)
    by_part["others"] = sorted(found.keys() - counted)
    return by_part


def _needed(requirements: Iterable[str], found: dict[str, Distribution]) -> set[str]:
    needed: set[tuple[str, str]] = set()  # each with the extra of it that is needed
    waiting = [Requirement(each) for each in requirements]
    while waiting:
        its = waiting.pop()
        name = canonicalize_name(its.name)
        asked = {(name, extra) for extra in ("", *its.extras)} if name in found else set()
        for _, extra in asked - needed:
            others = map(Requirement, found[name].requires or [])
            waiting += [each for each in others if _applies(each, extra)]
        needed |= asked
    return {name for name, _ in needed}


def _applies(requirement: Requirement, extra: str) -> bool:
    return not requirement.marker or requirement.marker.evaluate({"extra": extra})


def megabytes(distribution: Distribution) -> float:
    """What its files take."""
    paths = (distribution.locate_file(file) for file in distribution.files or ())
    return sum(os.path.getsize(path) for path in paths if os.path.isfile(path)) / 1e6


def main() -> None:
    """Print a row for each part."""
    found = {canonicalize_name(each.metadata["Name"]): each for each in distributions()}
    sizes = {name: megabytes(each) for name, each in found.items()}
    project = tomllib.loads(PROJECT.read_text(encoding="utf-8"))["project"]
    rows = []
    for part, names in parts(project, found).items():
        largest = sorted(names, key=sizes.get, reverse=True)[:LARGEST]
        named = ", ".join(f"{name} {sizes[name]:.0f}" for name in largest)
        rows.append([part, sum(map(sizes.get, names)), named])
    rows.append(["all", sum(sizes.values()), ""])
    print(tabulate(rows, headers=["for", "MB", "most of it"], floatfmt=".0f"))


if __name__ == "__main__":
    main()
