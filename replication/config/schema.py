"""The JSON schema of a configuration, from its types, for editors and for messages.

`python -m replication.config.schema` writes workflow/schemas/config.schema.json.
"""

import json
from collections.abc import Sequence
from functools import cache
from pathlib import Path

from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue

from recalib.files.storage import whole
from replication.config.messages import KeyPath
from replication.config.study import Study

FILE = Path("workflow/schemas/config.schema.json")


class _WithoutTitles(GenerateJsonSchema):
    """A generator that omits titles, because they would repeat the keys."""

    def field_title_should_be_set(self, schema: object) -> bool:
        return False


@cache  # generating it takes longer than reading a study
def json_schema() -> JsonSchemaValue:
    """The schema of a configuration."""
    return Study.model_json_schema(schema_generator=_WithoutTitles)


def text() -> str:
    """The content of the schema's file."""
    return json.dumps(json_schema(), indent=1) + "\n"


def find(location: Sequence[str | int]) -> tuple[KeyPath, JsonSchemaValue]:
    """The key's path and schema for a location in pydantic's errors, which includes choices."""
    schema = json_schema()
    path: KeyPath = ()
    for part in location:
        schema = resolved(schema)
        if "oneOf" in schema:
            schema = json_schema()["$defs"][part]
        else:
            schema, path = _at(schema, part), (*path, part)
    return path, schema


def _at(schema: JsonSchemaValue, part: str | int) -> JsonSchemaValue:
    """The schema of a key or an index; {} if there is none."""
    if isinstance(part, int):
        fixed = schema.get("prefixItems")
        return fixed[part] if fixed else schema.get("items", {})
    named = schema.get("patternProperties", {}).values()
    default = next(iter(named), schema.get("additionalProperties") or {})
    return schema.get("properties", {}).get(part, default)


def resolved(schema: JsonSchemaValue) -> JsonSchemaValue:
    """The schema itself, or the one that it refers to."""
    reference = schema.get("$ref")
    return json_schema()["$defs"][reference.rsplit("/")[-1]] if reference else schema


def keys(schema: JsonSchemaValue) -> list[str]:
    """The keys of a mapping."""
    return list(resolved(schema).get("properties", {}))


def meaning(schema: JsonSchemaValue) -> str:
    """The description of a key, for use within a sentence; "a value" if it has none."""
    text = schema.get("description") or resolved(schema).get("description", "A value.")
    return f"{text[0].lower()}{text[1:-1]}"


if __name__ == "__main__":
    with whole(FILE) as _path:
        _path.write_text(text(), encoding="utf-8")
