"""What is wrong with a configuration, in sentences: the key, what stood there, what would be valid."""

from collections.abc import Iterable, Mapping, Sequence
from difflib import get_close_matches
from typing import Any, NamedTuple

from recalib.errors import RecalibError

MOST_SHOWN = 10
LONGEST = 60  # characters of a value that are shown


class InvalidConfiguration(RecalibError):
    """A configuration with mistakes, a line for each of the first.

    Attributes:
        mistakes: all of the lines.
    """

    def __init__(self, mistakes: Sequence[str]):
        self.mistakes = list(mistakes)
        more = len(self.mistakes) - MOST_SHOWN
        rest = [f"... and {more} more"] if more > 0 else []
        super().__init__("\n".join([*self.mistakes[:MOST_SHOWN], *rest]))


Path = tuple[str | int, ...]


class Mistake(NamedTuple):
    """What is wrong at the path of a key: the rest of a sentence that begins with the path."""

    path: Path
    fault: str

    def __str__(self) -> str:
        return f"{dotted(self.path)}{self.fault}"


def dotted(path: Path) -> str:
    """A path as people write it: scenarios.translation[0].shorten."""
    parts = (f"[{part}]" if isinstance(part, int) else f".{part}" for part in path)
    return "".join(parts).removeprefix(".")


def nearest(word: str, valid: Iterable[str]) -> str | None:
    """The valid word that may have been meant."""
    return next(iter(get_close_matches(word, list(valid), 1)), None)


def unlike(path: Path, stood: Any, valid: str) -> Mistake:
    """A value that is none of the valid ones."""
    return Mistake(path, f" is {shown(stood)}; valid: {valid}")


def unknown(path: Path, name: str, valid: Iterable[str]) -> Mistake:
    """A name that is not among the valid ones."""
    valid = list(valid)
    near = nearest(name, valid)
    meant = f"; did you mean {near}?" if near else ""
    return Mistake(path, f" is {shown(name)}; valid: {listed(valid, 'or') or 'none'}{meant}")


def shown(value: Any) -> str:
    """A value as it would be written in YAML, without its length."""
    match value:
        case None:
            return "null"
        case bool():
            return str(value).lower()
        case str():
            return f"'{value}'" if len(value) <= LONGEST else f"'{value[:LONGEST]}...'"
        case Mapping():
            return "a mapping" if value else "an empty mapping"
        case list() | tuple():
            scalars = not any(isinstance(each, list | tuple | Mapping) for each in value)
            text = f"[{', '.join(map(shown, value))}]"
            return text if value and scalars and len(text) <= LONGEST else _sized(value)
    return str(value)


def _sized(value: Sequence) -> str:
    return f"a list of {len(value)}" if value else "an empty list"


def listed(words: Iterable[str], last: str) -> str:
    """Words with commas, and `last` before the last."""
    *rest, end = list(words) or [""]
    return f"{', '.join(rest)} {last} {end}" if rest else end


class Schema:
    """What a JSON schema says of a path: its meaning and what would be valid there.

    Args:
        schema: as pydantic makes it.
    """

    def __init__(self, schema: Mapping):
        self._root = schema

    def at(self, schema: Mapping, part: str | int) -> Mapping:
        """The schema of a key or an index; {} where there is none."""
        schema = self.resolved(schema)
        if isinstance(part, int):
            return (schema.get("prefixItems") or [schema.get("items", {})] * (part + 1))[part]
        named = schema.get("patternProperties", {}).values()
        whatever = next(iter(named), schema.get("additionalProperties") or {})
        return schema.get("properties", {}).get(part, whatever)

    def find(self, location: Sequence[str | int]) -> tuple[Path, Mapping]:
        """The path and the schema of a place in pydantic's errors, which name choices, too."""
        schema, path = self._root, ()
        for part in location:
            schema = self.resolved(schema)
            if "oneOf" in schema:
                schema = self._root["$defs"][part]
            else:
                schema, path = self.at(schema, part), (*path, part)
        return path, schema

    def resolved(self, schema: Mapping) -> Mapping:
        """The schema itself in the place of a reference to it, or of it or null."""
        for each in schema.get("anyOf", ()):
            if each.get("type") != "null":
                return self.resolved(each)
        reference = schema.get("$ref")
        return self._root["$defs"][reference.rsplit("/")[-1]] if reference else schema

    def keys(self, schema: Mapping) -> list[str]:
        """The keys of a mapping, the required ones first."""
        schema = self.resolved(schema)
        return [*schema.get("properties", {})]

    def valid(self, schema: Mapping) -> str:
        """What would be valid."""
        if {"type": "null"} in schema.get("anyOf", ()):
            return f"{self.valid(self.resolved(schema))}, or null"
        schema = self.resolved(schema)
        if "patternErrorMessage" in schema:
            return schema["patternErrorMessage"]
        if "enum" in schema:
            return listed(schema["enum"], "or")
        if "oneOf" in schema:
            return listed((" + ".join(self.keys(each)) for each in schema["oneOf"]), "or")
        match schema.get("type"):
            case "boolean":
                return "true or false"
            case "integer":
                return f"a whole number{_limits(schema)}"
            case "number":
                return f"a number{_limits(schema)}"
            case "array":
                return self._valid_list(schema)
            case "object" if "properties" in schema:
                return f"a mapping of {listed(self.keys(schema), 'and')}"
            case "object":
                return f"{_at_least(schema.get('minProperties', 0))}name with its value"
        return "text"

    def _valid_list(self, schema: Mapping) -> str:
        each = self.valid(self.at(schema, 0))
        if "prefixItems" in schema:
            return f"a list of {len(schema['prefixItems'])}, each {each}"
        return f"a list{' of one or more' if schema.get('minItems') else ''}, each {each}"


def _limits(schema: Mapping) -> str:
    limits = {
        "minimum": " from {}",
        "exclusiveMinimum": " above {}",
        "maximum": " to {}",
        "exclusiveMaximum": " and below {}",
    }
    return "".join(text.format(f"{schema[key]:.12g}") for key, text in limits.items() if key in schema)
