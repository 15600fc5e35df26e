"""What the types refuse, as mistakes: pydantic's errors without its prose."""

from collections.abc import Iterable, Mapping

from pydantic import ValidationError

from recalib.study.configuration.messages import KeyPath, Mistake, listed, nearest, shown, unlike
from recalib.study.configuration.schema import Schema, json_schema


def refusals(error: ValidationError) -> list[Mistake]:
    """A mistake for each error. A misspelt key is no missing one, too."""
    schema = Schema(json_schema())
    errors = error.errors(include_url=False)
    found: dict[KeyPath, Mistake] = {}
    for each in errors:
        mistake = _refusal(schema, each)
        found.setdefault(mistake.path, mistake)
    for path, meant in _misspelt(schema, errors).items():
        found[path] = Mistake(path, f": unknown key; did you mean {meant}?")
        found.pop((*path[:-1], meant), None)
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
