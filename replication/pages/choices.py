"""Choices in config.yaml, each with its reason, which is in a comment next to it."""

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import yaml

from replication.config.campaign import Factors


class Choice(NamedTuple):
    """A key of the configuration."""

    name: str  # its path, as in "search.trials"; for a factor of the campaign, its description
    values: tuple[str, ...]  # the value as text; for a factor, its levels
    reason: str  # the comments above the key and after the value


def read_choices(path: Path) -> dict[str, Choice]:
    """The keys of a configuration that have comments, by their paths."""
    text = path.read_text(encoding="utf-8")
    choices = _choices(yaml.compose(text), "", text)
    return {choice.name: choice for choice in choices if choice.reason}


def factor(name: str) -> str:
    """The description of a factor of the campaign."""
    return str(Factors.model_fields[name].description).rstrip(".")


def _choices(node: yaml.MappingNode, above: str, text: str) -> Iterator[Choice]:
    lines = text.splitlines()
    for key, value in node.value:
        name = f"{above}{key.value}"
        parts = [_above(key, lines), _behind(key, value, lines)]
        yield Choice(name, (_written(value, text),), " ".join(filter(None, parts)))
        if isinstance(value, yaml.MappingNode) and not value.flow_style:
            yield from _choices(value, f"{name}.", text)


def _above(key: yaml.Node, lines: list[str]) -> str:
    """The comment lines directly above a key, joined."""
    first = last = key.start_mark.line
    while lines[first - 1].startswith(f"{' ' * key.start_mark.column}# "):
        first -= 1
    return " ".join(" ".join(line.strip(" #").split()) for line in lines[first:last])


def _behind(key: yaml.Node, value: yaml.Node, lines: list[str]) -> str:
    """The comment on the last line of a value or, for a block, on the line of its key."""
    block = isinstance(value, yaml.CollectionNode) and not value.flow_style
    mark = key.end_mark if block else value.end_mark
    _, _, comment = lines[mark.line][mark.column :].partition("  # ")
    return comment


def _written(value: yaml.Node, text: str) -> str:
    """A value as it is written in the file; a block is joined into one line."""
    lines = text[value.start_mark.index : value.end_mark.index].splitlines()
    parts = (line.partition("  # ")[0].strip().removeprefix("- ") for line in lines)
    return ", ".join(filter(None, parts))
