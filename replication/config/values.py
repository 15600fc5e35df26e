"""YAML, read strictly: every value knows where it stands, and no key stands twice.

Words are those of YAML 1.2: `yes`, dates and 1:30 are text.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from os import PathLike, fspath
from pathlib import Path
from typing import Any

import yaml

from replication.config.messages import InvalidConfiguration, KeyPath

COMMAND_LINE = "the command line"
Place = tuple[str | int, ...]  # file, line, column


@dataclass(frozen=True)
class Placed:
    """A value and where it stands.

    Attributes:
        content: a scalar, or a mapping or a list of values.
        place: of its key, where it has one.
    """

    content: Any
    place: Place

    def plain(self) -> Any:
        """The same without places."""
        match self.content:
            case dict():
                return {key: value.plain() for key, value in self.content.items()}
            case list():
                return [value.plain() for value in self.content]
        return self.content

    def at(self, path: KeyPath) -> "Placed":
        """The value at a path, or the last one on the way to it."""
        value = self
        for part in path:
            try:
                value = value.content[part]
            except (KeyError, IndexError, TypeError):
                break
        return value

    def under(self, other: "Placed") -> "Placed":
        """This value with another laid over it: mappings key by key, anything else as a whole."""
        if not (isinstance(self.content, dict) and isinstance(other.content, dict)):
            return other
        laid = {
            key: self.content[key].under(value) if key in self.content else value
            for key, value in other.content.items()
        }
        return Placed(self.content | laid, self.place)


def from_mapping(data: Any, place: Place = (COMMAND_LINE,)) -> Placed:
    """Values that stand in no line of a file, such as those from the command line."""
    content: Any
    match data:
        case Mapping():
            content = {str(key): from_mapping(part, place) for key, part in data.items()}
        case list() | tuple():
            content = [from_mapping(part, place) for part in data]
        case _:
            content = data
    return Placed(content, place)


def from_file(path: str | PathLike) -> Placed:
    """Values of a YAML file. Raises InvalidConfiguration."""
    whole, here = Path(path).absolute(), Path.cwd()
    name = fspath(whole.relative_to(here) if whole.is_relative_to(here) else path)
    try:
        return _parsed(name, Path(path).read_text(encoding="utf-8-sig"))
    except yaml.MarkedYAMLError as error:
        raise InvalidConfiguration([_unreadable(name, error)]) from None
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        reason = error.strerror if isinstance(error, OSError) else "no text in UTF-8"
        raise InvalidConfiguration([f"{name}: {reason}"]) from None
    except RecursionError:
        reason = "an anchor within itself, or too many brackets"
        raise InvalidConfiguration([f"{name}: {reason}"]) from None


@cache  # several studies begin with one file
def _parsed(name: str, text: str) -> Placed:
    loader, start = _Loader(text), (name, 1, 1)
    loader.name = name
    node = loader.get_single_node()
    value = loader.value(node, start) if node else Placed(None, start)
    if not isinstance(value.content, dict) or not value.content:
        problem = f"{shown(start)}: no configuration; expected: keys with their values"
        raise InvalidConfiguration([problem])
    return value


def _unreadable(name: str, error: yaml.MarkedYAMLError) -> str:
    """PyYAML's reason in a sentence."""
    begun = f" in what begins in line {error.context_mark.line + 1}" if error.context_mark else ""
    return f"{shown(_place(name, error.problem_mark))}: no YAML: {error.problem}{begun}"


def _place(name: str, mark: yaml.Mark) -> Place:
    return name, mark.line + 1, mark.column + 1


def shown(place: Place) -> str:
    """A place as compilers write it."""
    return ":".join(map(str, place))


class _Loader(yaml.SafeLoader):
    """PyYAML's, with the words of YAML 1.2."""

    yaml_implicit_resolvers: dict = {}  # noqa: RUF012 as PyYAML declares it

    def value(self, node: yaml.Node, place: Place) -> Placed:
        """What a node says."""
        known = self.DEFAULT_SCALAR_TAG, self.resolve(type(node), node.value, (True, False))
        if node.tag not in known:
            _refuse(f"the tag {node.tag}", node)
        content: Any
        match node:
            case yaml.MappingNode():
                content = self._mapping(node)
            case yaml.SequenceNode():
                content = [
                    self.value(part, _place(self.name, part.start_mark)) for part in node.value
                ]
            case _:
                content = self.construct_object(node)
        return Placed(content, place)

    def _mapping(self, node: yaml.MappingNode) -> dict[str, Placed]:
        lines: dict[str, int] = {}
        for key, _ in node.value:
            if not isinstance(key, yaml.ScalarNode):
                _refuse("a key that is no text", key)
            if key.value in lines:
                _refuse(f"{key.value} stands twice, first in line {lines[key.value]}", key)
            lines[key.value] = key.start_mark.line + 1
        self.flatten_mapping(node)  # puts in what is merged by <<
        return {
            key.value: self.value(part, _place(self.name, key.start_mark))
            for key, part in node.value
        }


def _refuse(problem: str, node: yaml.Node) -> None:
    raise yaml.MarkedYAMLError(problem=problem, problem_mark=node.start_mark)


for kind, pattern, first in (
    ("merge", "<<", "<"),
    ("bool", "true|True|TRUE|false|False|FALSE", "tTfF"),
    ("null", "~|null|Null|NULL|", ["~", "n", "N", ""]),
    ("int", r"[-+]?[0-9]{1,18}", "-+0123456789"),
    (
        "float",
        r"[-+]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][-+]?[0-9]+)?|[-+]?\.(inf|Inf|INF)|\.(nan|NaN|NAN)",
        "-+0123456789.",
    ),
):
    _Loader.add_implicit_resolver(f"tag:yaml.org,2002:{kind}", re.compile(f"^({pattern})$"), first)
# YAML 1.2 has no octal numbers with a leading zero: 010 is ten, and 08 is eight.
_Loader.add_constructor("tag:yaml.org,2002:int", lambda loader, node: int(node.value))
