"""What the types refuse, as mistakes: the key, what stood there, and pydantic's own words."""

import re
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from functools import reduce
from operator import getitem
from typing import Any

from pydantic import ValidationError

from recalib.spelling import instead, listed, nearest
from recalib.study.configuration.messages import EXPECTED, KeyPath, Mistake, unlike
from recalib.study.configuration.schema import Schema, json_schema

MISSING = " is missing: "
KEY = "[key]"  # how pydantic ends the place of a key that is no valid name
# What it says of Python, said of YAML.
SAID = {
    r"^\w+ should (be|have) ": "",
    r"a valid dictionary.*": "a mapping",
    "a valid tuple": "a list",
    "a valid boolean": "true or false",
    " after validation, not .*": "",
}


def refusals(error: ValidationError, whole: Any) -> list[Mistake]:
    """What is wrong with the `whole` configuration: a mistake for each key.

    A misspelt key is no missing one, too.
    """
    schema, found = Schema(json_schema()), {}
    errors = sorted(error.errors(include_url=False), key=lambda its: its["type"] == "missing")
    absent = [schema.find(refusal["loc"])[0] for refusal in errors if refusal["type"] == "missing"]
    meant = set()
    for refusal in errors:
        if refusal["type"] == "too_short" and refusal["input"]:
            continue  # since none of its values is valid, which each of them says
        if refusal["type"] == "extra_forbidden":
            mistake, key = _unknown(schema, refusal["loc"], absent)
            meant.add(key)
        else:
            mistake = _refusal(schema, refusal, whole)
        if mistake.path not in meant:
            found.setdefault(mistake.path, mistake)
    return [*_together(found.values(), whole)]


def _together(mistakes: Iterable[Mistake], whole: Any) -> Iterator[Mistake]:
    """Several keys that one part lacks, and several wrong values of one list, told at once."""
    groups = defaultdict(list)
    for mistake in mistakes:
        missing = mistake.fault.startswith(MISSING)
        shared = missing or isinstance(mistake.path[-1], int)
        groups[mistake.path[:-1] if shared else mistake.path, missing].append(mistake)
    for (path, missing), its in groups.items():
        if len(its) == 1:
            yield its[0]
        elif missing:
            yield Mistake(path, f" lacks {listed((mistake.path[-1] for mistake in its), 'and')}")
        else:
            _, _, expected = its[0].fault.partition(EXPECTED)
            yield unlike(path, reduce(getitem, path, whole), f"each {expected}")


def _unknown(
    schema: Schema, location: tuple, absent: list[KeyPath]
) -> tuple[Mistake, KeyPath | None]:
    """An unknown key, and the path of the missing one that it probably stands for."""
    *_, key = location
    path, its = schema.find(location[:-1])
    lacking = [other[-1] for other in absent if other[:-1] == path]
    meant = nearest(key, lacking)
    fault = f"did you mean {meant}?" if meant else instead(key, schema.keys(its))
    return Mistake((*path, key), f": unknown key; {fault}"), (*path, meant) if meant else None


def _refusal(schema: Schema, error: Mapping, whole: Any) -> Mistake:
    *parents, last = location = error["loc"]
    path, its = schema.find(parents if last == KEY else location)
    if error["type"] == "missing" and isinstance(last, str):
        meaning = its.get("description") or schema.resolved(its)["description"]
        return Mistake(path, f"{MISSING}{meaning[0].lower()}{meaning[1:-1]}")
    if error["type"] == "missing":  # the last of so many in a list
        *parents, _ = path
        stood = reduce(getitem, parents, whole)
        return unlike(tuple(parents), stood, f"{last + 1} values or more")
    expected = error["msg"]
    for pattern, text in SAID.items():
        expected = re.sub(pattern, text, expected)
    return unlike(path, error["input"], expected)
