"""What the types refuse, as mistakes: pydantic's errors without its prose."""

from collections.abc import Mapping

from pydantic import ValidationError

from recalib.study.configuration.messages import KeyPath, Mistake, listed, nearest, shown, unlike
from recalib.study.configuration.schema import Schema, json_schema


def refusals(error: ValidationError) -> list[Mistake]:
    """A mistake for each error. A misspelt key is no missing one, too."""
    schema = Schema(json_schema())
    found: dict[KeyPath, Mistake] = {}
    misspelt = set()
    for each in error.errors(include_url=False):
        mistake, meant = _refusal(schema, each)
        found.setdefault(mistake.path, mistake)
        if meant:
            misspelt.add((*mistake.path[:-1], meant))
    return [each for path, each in found.items() if path not in misspelt]


def _refusal(schema: Schema, error: Mapping) -> tuple[Mistake, str | None]:
    """The mistake, and the key that an unknown one stands for."""
    location, stood = error["loc"], error["input"]
    if location[-1] == "[key]":
        path, its = schema.find(location[:-2])
        valid = schema.resolved(its)["propertyNames"]["patternErrorMessage"]
        return Mistake((*path, location[-2]), f": no valid name; valid: {valid}"), None
    path, its = schema.find(location)
    match error["type"]:
        case "extra_forbidden":
            _, parent = schema.find(location[:-1])
            keys = schema.keys(parent)
            near = nearest(str(path[-1]), keys)
            hint = f"did you mean {near}?" if near else f"valid: {listed(keys, 'and')}"
            return Mistake(path, f": unknown key; {hint}"), near
        case "missing" if isinstance(path[-1], str):
            meaning = its.get("description") or schema.resolved(its)["description"]
            return Mistake(path, f" is missing: {meaning[0].lower()}{meaning[1:-1]}"), None
        case "missing":  # the last of so many in a list
            path, its = schema.find(location[:-1])
        case "distinct":
            twice = shown(error["ctx"]["twice"])
            return Mistake(path, f" has {twice} twice; valid: each once"), None
        case "ordered":
            return unlike(path, stood, "the lower value first"), None
        case "union_tag_not_found" if stood and isinstance(stood, Mapping):
            return Mistake(
                (*path, next(iter(stood))), f": unknown key; valid: {schema.valid(its)}"
            ), None
    fault = unlike(path, stood, schema.valid(its)).fault
    near = nearest(stood, schema.resolved(its).get("enum", ())) if isinstance(stood, str) else None
    return Mistake(path, f"{fault}; did you mean {near}?" if near else fault), None
