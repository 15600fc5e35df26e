"""A strict reader of YAML: every value has its line and column, and duplicate keys are refused.

As in YAML 1.2, `yes`, dates and 1:30 are text.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from os import PathLike, fspath
from pathlib import Path
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.constructor import SafeConstructor
from ruamel.yaml.error import MarkedYAMLError, YAMLError
from ruamel.yaml.nodes import MappingNode, Node, ScalarNode, SequenceNode

from replication.config.messages import InvalidConfiguration, KeyPath

COMMAND_LINE = "the command line"
Place = tuple[str | int, ...]  # file, line, column


@dataclass(frozen=True)
class Placed:
    """A value and its place in a file."""

    content: Any  # a scalar, or a mapping or a list of values
    place: Place  # the place of its key, if it has one

    def plain(self) -> Any:
        """The same value without places."""
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
        """This value, overridden by another: mappings key by key, anything else as a whole."""
        if not (isinstance(self.content, dict) and isinstance(other.content, dict)):
            return other
        merged = {
            key: self.content[key].under(value) if key in self.content else value
            for key, value in other.content.items()
        }
        return Placed(self.content | merged, self.place)


def from_mapping(data: Any, place: Place = (COMMAND_LINE,)) -> Placed:
    """Values without a line in a file, such as those from the command line."""
    match data:
        case Mapping():
            data = {str(key): from_mapping(part, place) for key, part in data.items()}
        case list() | tuple():
            data = [from_mapping(part, place) for part in data]
    return Placed(data, place)


def from_file(path: str | PathLike[str]) -> Placed:
    """Values of a YAML file. Raises InvalidConfiguration."""
    absolute, folder = Path(path).absolute(), Path.cwd()
    name = fspath(absolute.relative_to(folder) if absolute.is_relative_to(folder) else path)
    try:
        return _parsed(name, Path(path).read_text(encoding="utf-8-sig"))
    except MarkedYAMLError as error:
        mark, of = error.problem_mark, error.context_mark
        context = f" in the part from line {of.line + 1}" if of else ""
        place = shown((name, mark.line + 1, mark.column + 1))
        problem = f"{place}: invalid YAML: {str(error.problem).strip()}{context}"
    except OSError as error:
        problem = f"{name}: {error.strerror}"
    except (UnicodeDecodeError, YAMLError):
        problem = f"{name}: not a text in UTF-8"
    except ValueError:
        problem = f"{name}: a value that does not fit its tag"
    except RecursionError:
        problem = f"{name}: an anchor within itself, or too many brackets"
    raise InvalidConfiguration([problem])


@cache  # several studies start from the same file
def _parsed(name: str, text: str) -> Placed:
    reader = YAML(typ="safe", pure=True)  # of YAML 1.2
    reader.Constructor = _Constructor
    start = (name, 1, 1)
    value = _with_places(reader.compose(text), reader.constructor, start)
    if not isinstance(value.content, dict) or not value.content:
        problem = f"{shown(start)}: no configuration; expected: keys with their values"
        raise InvalidConfiguration([problem])
    return value


class _Constructor(SafeConstructor):
    """Ruamel's constructor, except that dates are text."""


_Constructor.add_constructor("tag:yaml.org,2002:timestamp", SafeConstructor.construct_scalar)


def _with_places(node: Node | None, reader: SafeConstructor, place: Place) -> Placed:
    """The values of a node. Raises MarkedYAMLError if a key is duplicate or not text."""
    content: Any
    match node:
        case MappingNode():
            # the node of an alias may have been flattened before: skip its merged keys, in front
            keys = [key for key, _ in node.value[len(node.merge or ()) :]]
            for index, key in enumerate(keys):
                if key.value in [other.value for other in keys[:index]]:
                    raise _mistaken(f"duplicate key {key.value}", key)
            reader.flatten_mapping(node)  # puts keys merged by << in front
            for key, _ in node.value:
                if not isinstance(key, ScalarNode):
                    raise _mistaken("a key that is not text", key)
            content = {
                key.value: _with_places(part, reader, _place(key, place))
                for key, part in node.value
            }
        case SequenceNode():
            content = [_with_places(part, reader, _place(part, place)) for part in node.value]
        case ScalarNode() if node.tag not in reader.yaml_constructors:
            raise InvalidConfiguration([f"{shown(place)}: invalid YAML: unknown tag {node.tag}"])
        case _:
            content = reader.construct_object(node) if node else None
    return Placed(content, place)


def _mistaken(problem: str, node: Node) -> MarkedYAMLError:
    return MarkedYAMLError(problem=problem, problem_mark=node.start_mark)


def _place(node: Node, within: Place) -> Place:
    return within[0], node.start_mark.line + 1, node.start_mark.column + 1


def shown(place: Place) -> str:
    """A place as FILE:LINE:COLUMN."""
    return ":".join(map(str, place))
