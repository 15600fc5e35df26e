"""What the types refuse, as mistakes: pydantic's errors without its prose."""

from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping
from functools import reduce
from operator import getitem
from typing import Any

from pydantic import ValidationError

from recalib.spelling import listed, nearest
from recalib.study.configuration.messages import KeyPath, Mistake, shown, unlike
from recalib.study.configuration.schema import Schema, json_schema


def refusals(error: ValidationError, whole: Any) -> list[Mistake]:
    """What is wrong with the `whole` configuration: a mistake for what belongs together.

    A misspelt key is no missing one, too.
    """
    schema = Schema(json_schema())
    errors = error.errors(include_url=False)
    found: dict[KeyPath, Mistake] = {}
    for each in errors:
        mistake = _refusal(schema, each)
        found.setdefault(mistake.path, mistake)
    for path, meant in _misspelt(schema, errors).items():
        found[path] = Mistake(path, f": unknown key; did you mean {meant}?")
        found.pop((*path[:-1], meant), None)
    for mistake in (*_mixed(schema, errors), *_several(schema, errors, found, whole)):
        for path in [path for path in found if path[:-1] == mistake.path]:
            del found[path]
        found[mistake.path] = mistake
    return list(found.values())


def _misspelt(schema: Schema, errors: Iterable[Mapping]) -> dict[KeyPath, str]:
    """Unknown keys, with those that they probably stand for: similar, or the only one missing."""
    unknown, missing = (
        [each["loc"] for each in errors if each["type"] == kind]
        for kind in ("extra_forbidden", "missing")
    )
    meant = {}
    for location in unknown:
        *parent, key = location
        absent = [each[-1] for each in missing if [*each[:-1]] == parent]
        alone = len([each for each in unknown if [*each[:-1]] == parent]) == len(absent) == 1
        path, its = schema.find(parent)
        near = absent[0] if alone else nearest(key, absent) or nearest(key, schema.keys(its))
        if near:
            meant[*path, key] = near
    return meant


def _mixed(schema: Schema, errors: Iterable[Mapping]) -> Iterator[Mistake]:
    """Entries with words of two kinds: a shifted encoder that is shortened."""
    unknown = (each["loc"] for each in errors if each["type"] == "extra_forbidden")
    for *parent, kind, key in (location for location in unknown if len(location) > 1):
        path, its = schema.find(parent)
        kinds = [schema.keys(choice) for choice in schema.resolved(its).get("oneOf", ())]
        if others := [keys for keys in kinds if key in keys]:
            own = schema.keys(schema.find((*parent, kind))[1])
            valid = listed((" + ".join(keys) for keys in (own, *others)), "or")
            yield Mistake(path, f" has {own[0]} with {key}; valid: {valid}")


def _several(
    schema: Schema, errors: Iterable[Mapping], found: Collection[KeyPath], whole: Any
) -> Iterator[Mistake]:
    """Several keys that one part lacks, and several values of one list that are none."""
    lacking, wrong = defaultdict(list), defaultdict(list)
    for each in errors:
        path, _ = schema.find(each["loc"])
        if path in found and each["type"] == "missing":
            lacking[path[:-1]].append(path[-1])
        elif path in found and isinstance(path[-1], int):
            wrong[each["loc"][:-1]].append(path[-1])
    for path, keys in lacking.items():
        if len(keys) > 1:
            yield Mistake(path, f" lacks {listed(keys, 'and')}; valid: with all of them")
    for location, indices in wrong.items():
        if len(indices) > 1:
            path, its = schema.find(location)
            yield unlike(path, reduce(getitem, path, whole), schema.valid(its))


def _refusal(schema: Schema, error: Mapping) -> Mistake:
    location, stood = error["loc"], error["input"]
    if location[-1] == "[key]":
        path, its = schema.find(location[:-2])
        valid = schema.resolved(its)["propertyNames"]["patternErrorMessage"]
        return Mistake((*path, location[-2]), f": no valid name; valid: {valid}")
    path, its = schema.find(location)
    match error["type"]:
        case "extra_forbidden":
            keys = schema.keys(schema.find(location[:-1])[1])
            return Mistake(path, f": unknown key; valid: {listed(keys, 'and')}")
        case "missing" if isinstance(path[-1], str):
            meaning = its.get("description") or schema.resolved(its)["description"]
            return Mistake(path, f" is missing: {meaning[0].lower()}{meaning[1:-1]}")
        case "missing":  # the last of so many in a list
            path, its = schema.find(location[:-1])
        case "distinct":
            return Mistake(path, f" has {shown(error['ctx']['twice'])} twice; valid: each once")
        case "ordered":
            return unlike(path, stood, "the lower value first")
        case "union_tag_not_found" if stood and isinstance(stood, Mapping):
            path = (*path, next(iter(stood)))
            return Mistake(path, f": unknown key; valid: {schema.valid(its)}")
    mistake = unlike(path, stood, schema.valid(its))
    words = map(str, schema.resolved(its).get("enum", ()))
    near = nearest(stood, words) if isinstance(stood, str) else None
    return Mistake(path, f"{mistake.fault}; did you mean {near}?") if near else mistake
